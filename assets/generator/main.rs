//! Makes the levels and models of the playground: `cargo run -p embody_scenes --bin
//! generate_assets`. With `--check` it writes nothing and fails if a file is not what it makes.
//!
//! The measures are in `embody_scenes::course::layout`, from which the stations judge, and those of
//! the vehicles in their presets; what is here is how things look and what they are made of.

mod driving;
mod figures;
mod font;
mod glb;
mod level;
mod mesh;
mod paint;
mod vehicles;

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use level::Level;

/// Name of a file, and what fills it.
type Asset = (&'static str, fn(&mut Level));

/// Every file: the walking course, the proving ground, the vehicles.
const ASSETS: [Asset; 3] = [
    ("course", level::build),
    ("proving_ground", driving::build),
    ("vehicles", vehicles::build),
];

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../assets")
        .join(name)
        .with_extension("glb")
}

fn build((name, fill): Asset) -> Level {
    let mut level = Level {
        name,
        ..Level::default()
    };
    fill(&mut level);
    level
}

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool"
)]
fn main() -> ExitCode {
    let check = std::env::args().any(|argument| argument == "--check");
    let levels = ASSETS.into_iter().map(|asset| make(asset, check));
    let figures = figures::all()
        .into_iter()
        .map(|figure| figures::make(&figure, check));
    for made in levels.chain(figures) {
        match made {
            Ok(line) => println!("{line}"),
            Err(line) => {
                eprintln!("{line}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// Writes or checks a file; says what came of it.
fn make(asset: Asset, check: bool) -> Result<String, String> {
    let path = path(asset.0);
    let level = build(asset);
    let bytes =
        glb::encode(&level).map_err(|error| format!("cannot encode {}: {error}", asset.0))?;
    let triangles = level.nodes.iter().map(|node| node.mesh.triangles());
    let what = format!(
        "{} nodes, {} triangles",
        level.nodes.len(),
        triangles.sum::<usize>()
    );
    deliver(&path, &bytes, check, &what)
}

/// Writes a file, or checks that it is what would be written; says what came of it.
fn deliver(path: &Path, bytes: &[u8], check: bool, what: &str) -> Result<String, String> {
    let at = path.display();
    if check {
        return match std::fs::read(path) {
            Ok(found) if found == bytes => Ok(format!("{at} is what the generator makes")),
            Ok(_) => Err(format!("{at} is not what the generator makes")),
            Err(error) => Err(format!("cannot read {at}: {error}")),
        };
    }
    std::fs::write(path, bytes).map_err(|error| format!("cannot write {at}: {error}"))?;
    Ok(format!("{at}: {what}, {} bytes", bytes.len()))
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_file_is_what_its_generator_makes() {
        for asset in super::ASSETS {
            let made = super::glb::encode(&super::build(asset)).expect("it can be encoded");
            let found = std::fs::read(super::path(asset.0)).expect("it is there");
            assert!(made == found, "{} is not what the generator makes", asset.0);
        }
    }
}
