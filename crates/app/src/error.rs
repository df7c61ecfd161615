//! How the program can fail, and with which exit code.

use crate::scene::Findings;
use crate::scene::problem::{Severity, render_plain};
use std::io;
use std::process::ExitCode;
use thiserror::Error;

/// Why a command did not succeed.
#[derive(Debug, Error)]
pub enum AppError {
    /// A file cannot be read.
    #[error("cannot read {path}: {source}")]
    Read { path: String, source: io::Error },
    /// A file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write { path: String, source: io::Error },
    /// A failure that the user can do nothing about.
    #[error("{0}")]
    Internal(String),
    /// The command line asks for something that does not go together.
    #[error("{0}")]
    Usage(String),
    /// A scene is not valid.
    #[error("the scene is not valid")]
    Scene(Findings),
    /// A list of balls is not valid.
    #[error("{path}:{line}: {message}")]
    Balls { path: String, line: u64, message: String, help: Option<String> },
    /// A file of events is not valid.
    #[error("{path}:{line}: {message}")]
    Events { path: String, line: u64, message: String },
    /// A mesh is not valid.
    #[error("{0}")]
    Mesh(String),
    /// Balls were ended by a guard.
    #[error("{0}")]
    Guard(String),
    /// A target was not met.
    #[error("{0}")]
    Target(String),
}

impl AppError {
    /// The exit code, as `carom --help` lists them.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Read { .. } | Self::Write { .. } | Self::Internal(_) => 1,
            Self::Usage(_) => 2,
            Self::Scene(_) | Self::Balls { .. } | Self::Events { .. } | Self::Mesh(_) => 3,
            Self::Guard(_) => 4,
            Self::Target(_) => 5,
        })
    }

    /// The error as it is shown to the user.
    pub fn render(&self, styled: bool) -> String {
        match self {
            Self::Scene(findings) => findings.render(styled),
            Self::Balls { help, .. } => render_plain(Severity::Error, &self.to_string(), help.as_deref(), styled),
            _ => render_plain(Severity::Error, &self.to_string(), None, styled),
        }
    }
}
