//! `carom man`: the manual pages.

use super::print;
use crate::cli::{Cli, ManArgs};
use crate::error::AppError;
use clap::CommandFactory;
use clap_mangen::Man;
use std::io;

/// Prints the page of the program, or writes one for each command into a folder.
pub fn man(args: &ManArgs) -> Result<(), AppError> {
    let Some(folder) = &args.output else {
        let mut page = Vec::new();
        Man::new(Cli::command()).render(&mut page).map_err(|e| AppError::Internal(e.to_string()))?;
        return print(&String::from_utf8_lossy(&page));
    };
    let refused = |source: io::Error| AppError::Write { path: folder.display().to_string(), source };
    std::fs::create_dir_all(folder).map_err(refused)?;
    clap_mangen::generate_to(Cli::command(), folder).map_err(refused)
}
