//! `cargo xtask picture`: the README's picture, which is the page of `carom view` as a browser shows it.

use crate::Result;
use crate::project::{Project, output};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::{env, fs};

/// The run that is shown, and the moment of it.
const SCENE: &str = "crates/app/scenes/room.toml";
const MOMENT: &str = "t=1.35";

/// Where the pictures go, and what tells the browser which scheme the reader prefers.
const PICTURES: [(&str, &str); 2] = [
    ("docs/view-light.png", "--blink-settings=preferredColorScheme=1"),
    ("docs/view-dark.png", "--blink-settings=preferredColorScheme=0"),
];

/// Takes the pictures, in light and in dark.
pub fn take() -> Result<ExitCode> {
    let project = Project::find()?;
    let browser = ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(installed);
    let browser = browser.ok_or("no Chromium is installed, which takes the picture")?;
    let page = project.target().join("picture.html");
    let profile = project.target().join("picture-profile");
    output(&mut project.carom()?.command(["view", SCENE, "--output", &page.to_string_lossy()]))?;
    fs::create_dir_all(project.root().join("docs"))?;
    for (path, scheme) in PICTURES {
        let mut command = Command::new(browser);
        command.args(["--headless=new", "--no-sandbox", "--no-first-run", "--disable-background-networking"]);
        command.args(["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars"]);
        command.args(["--window-size=1200,750", "--virtual-time-budget=3000", scheme]);
        command.arg(format!("--user-data-dir={}", profile.display()));
        command.arg(format!("--screenshot={}", project.root().join(path).display()));
        command.arg(format!("file://{}#{MOMENT}", page.display()));
        output(&mut command)?;
        println!("{path} is new");
    }
    fs::remove_dir_all(profile)?;
    Ok(ExitCode::SUCCESS)
}

/// The program, if it is installed.
fn installed(name: &'static str) -> Option<&'static str> {
    let folders = env::var_os("PATH")?;
    env::split_paths(&folders).any(|folder| Path::new(&folder).join(name).is_file()).then_some(name)
}
