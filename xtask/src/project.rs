//! Where the project is, what it consists of, and how its cargo is called.

use crate::Result;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

/// The workspace on disk.
pub struct Project {
    root: PathBuf,
    target: PathBuf,
    cargo: OsString,
}

/// The program in its release build.
pub struct Carom {
    program: PathBuf,
    root: PathBuf,
}

/// A member of the workspace.
pub struct Member {
    /// Its folder, relative to the root, with forward slashes.
    pub folder: String,
    /// Its package name.
    pub name: String,
    /// Its description, one line.
    pub description: String,
    /// Whether it goes to a registry.
    pub published: bool,
}

impl Project {
    /// The project this task runs in.
    pub fn find() -> Result<Self> {
        // Cargo sets it for what it runs. The path at compile time would be wrong after the clone has moved.
        let manifest = env::var_os("CARGO_MANIFEST_DIR").ok_or("run it as `cargo xtask`")?;
        let root = Path::new(&manifest).parent().ok_or("xtask has no parent folder")?.to_path_buf();
        // A relative target folder is relative to where cargo was called, and the steps are called in the root.
        let target = match env::var_os("CARGO_TARGET_DIR") {
            Some(folder) => env::current_dir()?.join(folder),
            None => root.join("target"),
        };
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        Ok(Self { root, target, cargo })
    }

    /// The root of the workspace.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The folder of what is built.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Cargo with these arguments, in the root, in surroundings that do not depend on who calls it from where.
    pub fn cargo<const N: usize>(&self, arguments: [&str; N]) -> Command {
        let mut command = Command::new(&self.cargo);
        command.args(arguments).current_dir(&self.root).env("CARGO_TERM_COLOR", "never");
        if env::var_os("CARGO_TARGET_DIR").is_some() {
            command.env("CARGO_TARGET_DIR", &self.target);
        }
        // Cargo describes this task in the surroundings; the task's children are none of this package.
        for (name, _) in env::vars_os() {
            let text = name.to_string_lossy();
            if ["CARGO_PKG_", "CARGO_MANIFEST_", "CARGO_BIN_", "CARGO_CRATE_"]
                .iter()
                .any(|start| text.starts_with(start))
            {
                command.env_remove(&name);
            }
        }
        command
    }

    /// The program `carom`, its release build brought up to date.
    pub fn carom(&self) -> Result<Carom> {
        // Not by `cargo run`, which repeats the compiler's warnings among what the program says; and not by a guess at the
        // path, which a setting of cargo can move.
        const FORMAT: &str = "--message-format=json-render-diagnostics";
        let build = ["build", "--release", "--package", "carom", "--bin", "carom", FORMAT];
        let (messages, _) = output(&mut self.cargo(build))?;
        let program = executable(&messages).ok_or("cargo did not say where it put carom")?;
        Ok(Carom { program, root: self.root.clone() })
    }

    /// The scenes that come with the program, relative to the root, by name.
    pub fn scenes(&self) -> Result<Vec<String>> {
        const FOLDER: &str = "crates/app/scenes";
        let mut scenes = Vec::new();
        for entry in fs::read_dir(self.root.join(FOLDER)).map_err(|error| format!("{FOLDER}: {error}"))? {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".toml") {
                scenes.push(format!("{FOLDER}/{name}"));
            }
        }
        scenes.sort();
        if scenes.is_empty() {
            return Err(format!("{FOLDER} holds no scene").into());
        }
        Ok(scenes)
    }

    /// The members of the workspace, in the order of its manifest.
    pub fn members(&self) -> Result<Vec<Member>> {
        let manifest = self.read("Cargo.toml")?;
        let folders = value(&manifest, "members").ok_or("Cargo.toml: no line `members = [...]`")?;
        strings(folders).map(|folder| self.member(folder)).collect()
    }

    fn member(&self, folder: &str) -> Result<Member> {
        let path = format!("{folder}/Cargo.toml");
        let manifest = self.read(&path)?;
        let text = |key: &str| {
            let found = value(&manifest, key).and_then(|value| strings(value).next());
            found.map(str::to_owned).ok_or_else(|| format!("{path}: no line `{key} = \"...\"`"))
        };
        Ok(Member {
            folder: folder.to_owned(),
            name: text("name")?,
            description: text("description")?,
            published: value(&manifest, "publish") != Some("false"),
        })
    }

    /// A file of the project; the error names it.
    pub fn read(&self, path: &str) -> Result<String> {
        fs::read_to_string(self.root.join(path)).map_err(|error| format!("{path}: {error}").into())
    }
}

impl Carom {
    /// The program with these arguments, in the root. It does not see how wide the terminal is.
    pub fn command<const N: usize>(&self, arguments: [&str; N]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(arguments).current_dir(&self.root).env("NO_COLOR", "1").env_remove("COLUMNS");
        command
    }
}

/// The executable in the messages of `cargo build`, which are JSON, one a line.
fn executable(messages: &str) -> Option<PathBuf> {
    let (_, path) = messages.lines().rev().find_map(|line| line.split_once("\"executable\":\""))?;
    Some(path.split('"').next()?.replace(r"\\", r"\").into())
}

/// Standard output and standard error of a command that must end well.
pub fn output(command: &mut Command) -> Result<(String, String)> {
    // No terminal on any side: a program that asks for its width gets none.
    let output = command.stdin(Stdio::null()).output()?;
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if !output.status.success() {
        return Err(format!("`{}` ended with {}\n{err}", show(command), output.status).into());
    }
    Ok((out.into_owned(), err.into_owned()))
}

/// A command as one would type it.
pub fn show(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// What stands behind the first line `key = ` of a manifest. The manifests are the project's own and keep one key to a
/// line, so nothing here needs the whole of TOML.
fn value<'a>(manifest: &'a str, key: &str) -> Option<&'a str> {
    manifest.lines().find_map(|line| line.strip_prefix(key)?.trim_start().strip_prefix('=')).map(str::trim)
}

/// The quoted strings of a value.
fn strings(value: &str) -> impl Iterator<Item = &str> {
    value.split('"').skip(1).step_by(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_shown_as_typed() {
        assert_eq!(show(Command::new("/usr/bin/cargo").args(["fmt", "--all"])), "cargo fmt --all");
    }

    #[test]
    fn the_executable_is_found_in_cargos_messages() {
        let messages = concat!(
            r#"{"reason":"compiler-artifact","filenames":["a.rlib"],"executable":null,"fresh":true}"#,
            "\n",
            r#"{"reason":"compiler-artifact","executable":"C:\\t\\carom.exe","fresh":false}"#,
            "\n",
            r#"{"reason":"build-finished","success":true}"#
        );
        assert_eq!(executable(messages), Some(PathBuf::from(r"C:\t\carom.exe")));
        assert_eq!(executable("{}"), None);
    }

    #[test]
    fn a_manifest_is_read_by_whole_keys() {
        let manifest =
            "[workspace]\ndefault-members = [\"c\"]\nmembers = [\"a\", \"b/c\"]\nname = \"x\"\npublish = false\n";
        assert_eq!(value(manifest, "members").map(|v| strings(v).collect()), Some(vec!["a", "b/c"]));
        assert_eq!(value(manifest, "publish"), Some("false"));
        assert_eq!(value(manifest, "member"), None);
        assert_eq!(value(manifest, "description"), None);
    }
}
