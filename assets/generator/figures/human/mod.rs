//! A human of 1.80 m.

mod body;
pub mod bones;
pub mod gait;
mod get_up;
mod idle;
#[cfg(test)]
pub mod limits;
mod once;
pub mod pose;

use super::clip::Figure;

pub fn figure() -> Figure {
    let skeleton = bones::skeleton();
    Figure {
        name: "human",
        gates: bones::gates(&skeleton),
        shells: body::shells(),
        clips: vec![
            idle::clip(&skeleton),
            gait::WALK.clip(&skeleton),
            gait::RUN.clip(&skeleton),
            once::jump(&skeleton),
            once::hit(&skeleton),
            get_up::front(&skeleton),
            get_up::back(&skeleton),
        ],
        skeleton,
    }
}
