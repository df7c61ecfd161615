//! Tests of the real program: what it is given, what it says, what it leaves.

mod accuracy;
mod bad_input;
mod commands;
mod common;
mod run;
mod scenes;
