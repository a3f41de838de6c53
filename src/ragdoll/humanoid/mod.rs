//! The standard human figure: 10, 15, 19 or 23 bodies with the segment masses and joint ranges of
//! anatomy.
//!
//! Segment masses, centres and radii of gyration are those of Dempster as given by Winter (1990);
//! lengths those of Drillis and Contini. Where the tables stop, trunk, neck and shoulder girdle are
//! divided by estimate.

mod joints;
mod part;
mod plan;
mod rig;

pub use part::{BodyPart, HumanoidDetail};
pub(crate) use plan::first_part;
pub use rig::HumanoidRig;
