//! Makes `assets/course.glb`, the level of the playground: `cargo run -p embody_scenes --bin
//! generate_assets`. With `--check` it writes nothing and fails if the file is not what it makes.
//!
//! The measures are in `embody_scenes::course::layout`, from which the stations judge; what is
//! here is how things look and what they are made of.

mod figures;
mod font;
mod glb;
mod level;
mod mesh;
mod paint;

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use level::Level;

/// Where the level is.
fn course() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/course.glb")
}

fn build() -> Level {
    let mut level = Level::default();
    level::build(&mut level);
    level
}

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool"
)]
fn main() -> ExitCode {
    let check = std::env::args().any(|argument| argument == "--check");
    for figure in figures::all() {
        match figures::make(&figure, check) {
            Ok(line) => println!("{line}"),
            Err(line) => {
                eprintln!("{line}");
                return ExitCode::FAILURE;
            }
        }
    }
    let path = course();
    let level = build();
    let bytes = match glb::encode(&level) {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("cannot encode the level: {error}");
            return ExitCode::FAILURE;
        }
    };
    if check {
        return match std::fs::read(&path) {
            Ok(found) if found == bytes => {
                println!("{} is what the generator makes", path.display());
                ExitCode::SUCCESS
            }
            Ok(_) => {
                eprintln!("{} is not what the generator makes", path.display());
                ExitCode::FAILURE
            }
            Err(error) => {
                eprintln!("cannot read {}: {error}", path.display());
                ExitCode::FAILURE
            }
        };
    }
    if let Err(error) = std::fs::write(&path, &bytes) {
        eprintln!("cannot write {}: {error}", path.display());
        return ExitCode::FAILURE;
    }
    println!(
        "{}: {} nodes, {} triangles, {} bytes",
        path.display(),
        level.nodes.len(),
        level
            .nodes
            .iter()
            .map(|node| node.mesh.triangles())
            .sum::<usize>(),
        bytes.len()
    );
    ExitCode::SUCCESS
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_course_is_what_its_generator_makes() {
        let made = super::glb::encode(&super::build()).expect("the level can be encoded");
        let found = std::fs::read(super::course()).expect("the level is there");
        assert!(
            made == found,
            "assets/course.glb is not what the generator makes"
        );
    }
}
