//! Tests of the real program: what it is given, what it says, what it leaves.

mod bad_input;
mod commands;
mod common;
mod compare;
mod first_steps;
mod run;
mod scenes;
