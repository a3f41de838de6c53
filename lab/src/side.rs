//! Who is measured: our controller or its peer, in otherwise equal apps.

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Whose controller moves the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// That of this project.
    Ours,
    /// That of Rapier.
    Rapier,
}

impl Side {
    pub fn name(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Rapier => "rapier",
        }
    }
}
