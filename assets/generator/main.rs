//! Makes `assets/course.glb`, the level of the playground: `cargo run -p embody_scenes --bin
//! generate_assets`. With `--check` it writes nothing and fails if the file is not what it makes.
//!
//! The measures are in `embody_scenes::course::layout`, from which the stations judge; what is
//! here is how things look and what they are made of.

mod font;
mod glb;
mod level;
mod mesh;
mod paint;

use std::{path::Path, process::ExitCode};

use level::Level;

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool"
)]
fn main() -> ExitCode {
    let check = std::env::args().any(|argument| argument == "--check");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/course.glb");
    let mut level = Level::default();
    level::build(&mut level);
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
