//! Skinned figures with clips: a human and a dog.

#[cfg(test)]
mod checks;
mod clip;
mod curve;
pub mod dog;
mod field;
mod file;
pub mod human;
mod ik;
mod skeleton;
mod skin;
mod surface;

use std::path::{Path, PathBuf};

pub use clip::Figure;
pub use file::encode;

/// All of them.
pub fn all() -> Vec<Figure> {
    vec![human::figure(), dog::figure()]
}

/// Where the file of a figure is.
pub fn path(figure: &Figure) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../assets")
        .join(figure.name)
        .with_extension("glb")
}
