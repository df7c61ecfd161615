//! `carom view`: a run as a page that any browser shows.

use crate::cli::ViewArgs;
use crate::error::AppError;
use crate::output::target::{Target, is_stdout, require_extension};
use crate::replay::Replay;
use crate::terminal::say;
use crate::view;

/// Simulates the scene and writes the page.
pub fn view(args: &ViewArgs) -> Result<(), AppError> {
    require_extension(&args.output, "html")?;
    // A place where nothing can be written is known before the run.
    let mut out = Target::open(&args.output)?;
    let replay = Replay::of(&args.input.scene, &args.input.how)?;
    let title = args.input.scene.file_name().unwrap_or_default().to_string_lossy();
    out.write(view::page(&title, &replay).as_bytes())?;
    out.finish()?;
    if !args.input.how.quiet {
        say(&replay.summary.text());
        if !is_stdout(&args.output) {
            say(&format!("page      {}, for any browser", args.output.display()));
        }
    }
    replay.conclude()
}
