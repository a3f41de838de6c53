//! Skinned figures with clips: `assets/human.glb` and `assets/dog.glb`.
//!
//! They face `+Z`, as glTF has it, with their left at `+X`, feet on the ground at the origin,
//! in metres; Bevy's loader turns them to `-Z` with
//! `GltfConvertCoordinates::rotate_scene_entity`. Clips play on the spot: `extras` of each say
//! whether it loops and how fast the ground passes, metres per second.

#[cfg(test)]
mod checks;
mod clip;
mod curve;
mod dog;
mod field;
mod file;
mod human;
mod ik;
mod skeleton;
mod skin;
mod surface;

use std::path::{Path, PathBuf};

pub use clip::Figure;
use file::encode;

/// All of them.
pub fn all() -> Vec<Figure> {
    vec![human::figure(), dog::figure()]
}

/// Where the file of a figure is.
fn path(figure: &Figure) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../assets")
        .join(figure.name)
        .with_extension("glb")
}

/// Writes or checks the file of a figure; says what came of it.
pub fn make(figure: &Figure, check: bool) -> Result<String, String> {
    let path = path(figure);
    let bytes =
        encode(figure).map_err(|error| format!("cannot encode {}: {error}", path.display()))?;
    let triangles = figure.shells.iter().map(|shell| shell.triangles.len());
    let what = format!(
        "{} bones, {} clips, {} triangles",
        figure.skeleton.bones.len(),
        figure.clips.len(),
        triangles.sum::<usize>()
    );
    crate::deliver(&path, &bytes, check, &what)
}
