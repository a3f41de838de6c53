//! Skinned figures with clips: a human and a dog.

mod clip;
mod curve;
mod field;
mod file;
pub mod human;
mod ik;
mod skeleton;
mod skin;
mod surface;

pub use clip::Figure;
pub use file::encode;

/// All of them.
pub fn all() -> Vec<Figure> {
    vec![human::figure()]
}
