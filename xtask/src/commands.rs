//! Whether the commands that the README shows exist.

use crate::project::{Carom, Project};
use crate::{Result, TASKS};
use std::collections::BTreeMap;

/// What is wrong with the commands in a Markdown text, a sentence each.
pub fn wrong(project: &Project, carom: &Carom, text: &str) -> Result<Vec<String>> {
    let mut wrong = Vec::new();
    // Each subcommand is asked once for its help.
    let mut helps = BTreeMap::new();
    for command in shown(text) {
        let words: Vec<&str> = command.split_whitespace().collect();
        let mut say = |what: String| wrong.push(format!("`{command}`: {what}"));
        for path in words.iter().filter(|word| is_path(word) && !project.root().join(word).exists()) {
            say(format!("there is no {path}"));
        }
        match words[..] {
            ["cargo", "xtask", task, ..] if !TASKS.contains(&task) => say(format!("there is no task {task}")),
            ["cargo", "run", "-p", package, "--example", name, ..] => {
                let folder = package.strip_prefix("carom-").unwrap_or("app");
                if !project.root().join(format!("crates/{folder}/examples/{name}.rs")).exists() {
                    say(format!("{package} has no example {name}"));
                }
            }
            ["cargo", "run", ..] | ["carom", ..] => {
                let arguments = carom_arguments(&words);
                let subcommand = arguments.first().copied().unwrap_or("help");
                if !helps.contains_key(subcommand) {
                    helps.insert(subcommand.to_owned(), help(carom, subcommand)?);
                }
                match &helps[subcommand] {
                    Some(help) => {
                        for option in arguments.iter().filter(|word| word.starts_with("--") && !has_option(help, word))
                        {
                            say(format!("carom {subcommand} has no option {option}"));
                        }
                    }
                    None => say(format!("carom has no command {subcommand}")),
                }
            }
            _ => {}
        }
    }
    Ok(wrong)
}

/// The commands of a text: the lines of its `sh` blocks, and those behind a `$` in its `console` blocks.
fn shown(text: &str) -> Vec<&str> {
    let mut commands = Vec::new();
    let mut language = None;
    for line in text.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix("```") {
            language = if language.is_some() { None } else { Some(name) };
            continue;
        }
        let command = match language {
            Some("sh") => line,
            Some("console") => line.strip_prefix("$ ").unwrap_or_default(),
            _ => "",
        };
        let command = command.split(" #").next().unwrap_or_default().trim();
        if !command.is_empty() && !command.starts_with('#') {
            commands.push(command);
        }
    }
    commands
}

/// A path of the project, as against the name of an output or of an option.
fn is_path(word: &str) -> bool {
    ["crates/", "tests/", "xtask/", ".ci/", "./.ci/"].iter().any(|start| word.starts_with(start))
}

/// What of a command goes to `carom`.
fn carom_arguments<'a>(words: &'a [&'a str]) -> &'a [&'a str] {
    match words.iter().position(|word| *word == "--") {
        Some(end) if words[0] == "cargo" => &words[end + 1..],
        _ if words[0] == "carom" => &words[1..],
        _ => &[],
    }
}

/// The help of a subcommand, if there is such a one.
fn help(carom: &Carom, subcommand: &str) -> Result<Option<String>> {
    let output = carom.command([subcommand, "--help"]).output()?;
    Ok(output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned()))
}

fn has_option(help: &str, option: &str) -> bool {
    let name = option.split('=').next().unwrap_or(option);
    help.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).any(|word| word == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_the_lines_of_sh_blocks_and_behind_prompts() {
        let text = "```sh\n# a comment\ncargo xtask verify   # all\n```\ntext\n```text\nno\n```\n```console\n$ carom run x\nout\n```\n";
        assert_eq!(shown(text), ["cargo xtask verify", "carom run x"]);
    }

    #[test]
    fn the_arguments_of_carom_begin_behind_the_dashes() {
        let words = ["cargo", "run", "--release", "--", "run", "x", "--fps", "30"];
        assert_eq!(carom_arguments(&words), ["run", "x", "--fps", "30"]);
        assert_eq!(carom_arguments(&["carom", "check", "x"]), ["check", "x"]);
        assert!(carom_arguments(&["cargo", "run", "--release"]).is_empty());
    }

    #[test]
    fn an_option_is_a_whole_word_of_the_help() {
        let help = "      --events <FILE>  where the events go\n";
        assert!(has_option(help, "--events") && has_option(help, "--events=x"));
        assert!(!has_option(help, "--event") && !has_option(help, "--frames"));
    }
}
