//! A dog of 0.58 m at the shoulders.

mod body;
pub mod bones;
mod clips;
mod pose;

use super::clip::Figure;

pub fn figure() -> Figure {
    let skeleton = bones::skeleton();
    Figure {
        name: "dog",
        gates: bones::gates(&skeleton),
        shells: body::shells(),
        clips: vec![
            clips::idle(&skeleton),
            clips::WALK.clip(&skeleton),
            clips::TROT.clip(&skeleton),
            clips::lie(&skeleton),
        ],
        skeleton,
    }
}
