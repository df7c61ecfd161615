//! `carom export`: a run as a model for other programs.

use crate::cli::ExportArgs;
use crate::error::AppError;
use crate::model;
use crate::output::target::{Target, is_stdout, require_extension};
use crate::replay::Replay;
use crate::terminal::say;

/// More keys than this are taken for a slip.
const KEY_LIMIT: f64 = 1e8;

/// Simulates the scene and writes the model.
pub fn export(args: &ExportArgs) -> Result<(), AppError> {
    require_extension(&args.output, "glb")?;
    let mut out = Target::open(&args.output)?;
    let replay = Replay::of(&args.input.scene, &args.input.how)?;
    if let model::Keys::Frames { fps } = args.keys
        && fps * replay.scene.duration * replay.balls.len() as f64 > KEY_LIMIT
    {
        let message = format!("--keys fps={fps} makes too many keys for this scene; choose fewer");
        return Err(AppError::Usage(message));
    }
    let name = args.input.scene.file_stem().unwrap_or_default().to_string_lossy();
    out.write(&model::glb(&name, &replay, args.keys)?)?;
    out.finish()?;
    if !args.input.how.quiet {
        say(&replay.summary.text());
        if !is_stdout(&args.output) {
            say(&format!("model     {}, keys: {}", args.output.display(), args.keys));
        }
    }
    replay.conclude()
}
