//! What can be wrong with a level.

use std::{fmt, path::PathBuf};

/// Why a level could not be loaded.
#[derive(Debug)]
pub enum CourseError {
    /// The file could not be read.
    Read(PathBuf, std::io::Error),
    /// The file is no valid glTF 2.0.
    Gltf(gltf::Error),
    /// What a node says about its physics is not understood.
    Extras {
        /// Name of the node.
        node: String,
        /// What is wrong, and where.
        error: serde_json::Error,
    },
    /// A node is something that a level cannot have.
    Node {
        /// Name of the node.
        node: String,
        /// What is wrong.
        problem: String,
    },
}

impl fmt::Display for CourseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(path, error) => write!(f, "cannot read {}: {error}", path.display()),
            Self::Gltf(error) => write!(f, "not a glTF 2.0 level: {error}"),
            Self::Extras { node, error } => write!(f, "extras of node {node:?}: {error}"),
            Self::Node { node, problem } => write!(f, "node {node:?}: {problem}"),
        }
    }
}

impl core::error::Error for CourseError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Read(_, error) => Some(error),
            Self::Gltf(error) => Some(error),
            Self::Extras { error, .. } => Some(error),
            Self::Node { .. } => None,
        }
    }
}
