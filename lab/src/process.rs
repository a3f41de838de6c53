//! Measuring a world in a fresh process of this binary.

use std::process::Command;

use clap::ValueEnum;

use crate::run::{Measured, Options};

/// Runs a world on its own, by this command if there is one: `nice -n -5`, or a script that quiets the
/// machine meanwhile.
pub fn measure(options: &Options, under: &[String]) -> Result<Measured, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let side = options
        .only
        .to_possible_value()
        .map(|value| value.get_name().to_owned())
        .unwrap_or_default();
    let mut command = match under.split_first() {
        Some((first, rest)) => {
            let mut command = Command::new(first);
            command.args(rest).arg(program);
            command
        }
        None => Command::new(program),
    };
    command
        // The threads of the solver, where it is built to have some.
        .env("RAYON_NUM_THREADS", options.threads.to_string())
        .arg("profile")
        .arg("--json")
        .args(["--scene", &options.scene])
        .args(["--only", &side])
        .args(["--threads", &options.threads.to_string()])
        .args(["--count", &options.count.to_string()])
        .args(["--steps", &options.steps.to_string()]);
    if let Some(warm_up) = options.warm_up {
        command.args(["--warm-up", &warm_up.to_string()]);
    }
    let output = command.output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{command:?} ended with {}: {said}", output.status));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("{command:?}: {error}"))
}
