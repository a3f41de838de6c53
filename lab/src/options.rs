//! What the commands that write tables have in common.

use std::path::PathBuf;

use clap::Args;

/// What to measure, and where to write it.
#[derive(Args, Clone, Debug)]
pub struct Selection {
    /// Only what has this in its name.
    #[arg(long)]
    filter: Option<String>,
    /// A part of it that takes seconds.
    #[arg(long)]
    pub quick: bool,
    /// Writes everything into this folder as well.
    #[arg(long)]
    pub out: Option<PathBuf>,
}

impl Selection {
    /// Whether what is called so is asked for.
    pub fn wants(&self, name: &str) -> bool {
        let filter = self.filter.as_deref().unwrap_or_default();
        name.contains(filter)
    }
}
