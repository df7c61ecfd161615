//! Bouncing-ball simulation from the command line.

fn main() {}
