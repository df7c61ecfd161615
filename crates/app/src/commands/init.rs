//! `carom init`: a first scene to change.

use super::print;
use crate::cli::InitArgs;
use crate::error::AppError;
use crate::output::target::is_stdout;
use crate::terminal::say;
use std::fs::File;
use std::io::{ErrorKind, Write};

const FIRST_SCENE: &str = include_str!("../../data/first-scene.toml");

/// Writes the scene, unless there is a file already.
pub fn init(args: &InitArgs) -> Result<(), AppError> {
    let path = &args.file;
    if is_stdout(path) {
        return print(FIRST_SCENE);
    }
    let shown = path.display();
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("toml")) {
        return Err(AppError::Usage(format!(
            "{shown}: the scene is written as TOML; choose a name that ends in .toml"
        )));
    }
    let written = File::create_new(path).and_then(|mut file| file.write_all(FIRST_SCENE.as_bytes()));
    match written {
        Ok(()) => {}
        Err(e) if e.kind() == ErrorKind::AlreadyExists => {
            return Err(AppError::Usage(format!("{shown} is there already and stays as it is; choose another name")));
        }
        Err(source) => return Err(AppError::Write { path: shown.to_string(), source }),
    }
    let page = path.with_extension("html");
    say(&format!(
        "{shown} is a scene to change. Next:\n  carom run {shown}\n  carom view {shown} -o {}",
        page.display()
    ));
    Ok(())
}
