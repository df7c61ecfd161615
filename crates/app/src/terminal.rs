//! Standard error: what the user reads while results go elsewhere.

use anstream::{AutoStream, ColorChoice};
use std::io::{self, Write};

/// Whether messages may have colours: a terminal that has them, and no NO_COLOR.
pub fn styled() -> bool {
    AutoStream::choice(&io::stderr()) != ColorChoice::Never
}

/// Writes a message and ends its line. A standard error that nobody reads is no reason to fail.
pub fn say(message: &str) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}
