//! Scene files: TOML or JSON into a scene, every fault with its place.

mod air;
mod balls;
mod build;
mod choices;
mod de;
pub mod file;
mod parse;
pub mod problem;
mod shapes;
mod tree;

use crate::balls::{self as ball_lists, BallList};
use crate::commands::accuracy::setting;
use crate::error::AppError;
use crate::terminal::say;
use carom_dynamics::accuracy::choose;
use carom_dynamics::error::SceneError;
use carom_dynamics::explain::choice::{Choice, choose as choose_effects};
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use file::{EffectsShare, EffectsTable, EffectsWord, SceneFile};
use parse::Notation;
use problem::Problem;
use std::path::Path;
use tree::{Node, Step};

/// To what share effects are chosen if the scene does not say.
const PERCENT: f64 = 0.01;

/// A scene, and what it takes to say where in its file something is.
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// How its effects were chosen, if they were.
    pub choice: Option<Choice>,
    source: Source,
    balls: BallOrigin,
    /// The error in m for which the method is to be chosen, if it is.
    auto: Option<f64>,
}

/// Where the balls of a scene were read.
enum BallOrigin {
    /// From `[[balls]]`: the number of the table for each ball.
    Tables(Vec<usize>),
    /// From a list.
    List(BallList),
}

/// The text of a scene file and its tree.
struct Source {
    path: String,
    text: String,
    tree: Node,
}

/// All that was found in a file, for the eye.
#[derive(Debug)]
pub struct Findings {
    path: String,
    text: String,
    problems: Vec<Problem>,
}

impl Findings {
    /// The findings one after the other, in the order of the file, and how many there are.
    pub fn render(&self, styled: bool) -> String {
        let mut parts: Vec<String> = self.problems.iter().map(|p| p.render(&self.path, &self.text, styled)).collect();
        if let n @ 2.. = parts.len() {
            parts.push(format!("{}: {n} errors", self.path));
        }
        parts.join("\n\n")
    }
}

/// Whether the extension of `path` is that of a scene file.
pub fn is_scene(path: &Path) -> bool {
    notation(path).is_some()
}

fn notation(path: &Path) -> Option<Notation> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "toml" => Some(Notation::Toml),
        "json" => Some(Notation::Json),
        _ => None,
    }
}

/// Reads the scene at `path`; with `balls`, its balls come from that list (`-` is standard input) and not from the scene.
///
/// Fails with all that is wrong with the file: unknown keys and wrong types first, then values.
pub fn load(path: &Path, balls: Option<&Path>) -> Result<Loaded, AppError> {
    let shown = path.display().to_string();
    let Some(notation) = notation(path) else {
        return Err(AppError::Usage(format!("{shown}: a scene file ends in .toml or .json")));
    };
    let bytes = std::fs::read(path).map_err(|source| AppError::Read { path: shown.clone(), source })?;
    let (text, broken) = match String::from_utf8(bytes) {
        Ok(text) => (text, None),
        Err(e) => (String::from_utf8_lossy(e.as_bytes()).into_owned(), Some(e.utf8_error().valid_up_to())),
    };
    let text = match text.strip_prefix('\u{feff}') {
        Some(text) => text.to_owned(),
        None => text,
    };
    let fail = |text: String, problems: Vec<Problem>| Err(AppError::Scene(findings(&shown, text, problems)));
    if let Some(at) = broken {
        return fail(text, vec![Problem::new("the file is not UTF-8 text").at(at..at)]);
    }
    let tree = match parse::parse(&text, notation) {
        Ok(tree) => tree,
        Err(problem) => return fail(text, vec![problem]),
    };
    let file = match structure(&tree) {
        Ok(file) => file,
        Err(problems) => return fail(text, problems),
    };
    let mut builder = build::Builder { tree: &tree, problems: Vec::new(), auto: None };
    let folder = path.parent().unwrap_or(Path::new(""));
    let (mut scene, tables) = builder.scene(&file, folder);
    let (problems, auto) = (builder.problems, builder.auto);
    if !problems.is_empty() {
        return fail(text, problems);
    }
    let mut origin = BallOrigin::Tables(tables);
    if let Some(list) = balls {
        let list = ball_lists::read(list)?;
        scene.balls = list.balls.clone();
        origin = BallOrigin::List(list);
    }
    let loaded = Loaded { scene, choice: None, source: Source { path: shown, text, tree }, balls: origin, auto };
    let tolerance = match file.effects {
        None => return Ok(loaded),
        Some(EffectsTable::Word(EffectsWord::Auto)) => PERCENT,
        Some(EffectsTable::Share(EffectsShare { auto })) => auto,
    };
    let choice = choose_effects(&loaded.scene, tolerance).map_err(|error| loaded.refuse(&error))?;
    Ok(Loaded { scene: choice.scene.clone(), choice: Some(choice), ..loaded })
}

/// The keys and types of a scene, or all that is wrong with them.
fn structure(tree: &Node) -> Result<SceneFile, Vec<Problem>> {
    let non_finite = tree.non_finite();
    let mut problems: Vec<Problem> =
        non_finite.into_iter().map(|(span, x)| Problem::new(format!("{x} is not a finite number")).at(span)).collect();
    match de::from_node(tree.clone()) {
        Ok(file) if problems.is_empty() => Ok(file),
        Ok(_) => Err(problems),
        Err(more) => {
            problems.extend(more);
            Err(problems)
        }
    }
}

fn findings(path: &str, text: String, mut problems: Vec<Problem>) -> Findings {
    problems.sort_by_key(|p| p.span().map_or(0, |span| span.start));
    Findings { path: path.to_owned(), text, problems }
}

impl Loaded {
    /// The scene made ready. If its method is to be chosen, this chooses it, which takes runs of the first balls with every method, and says
    /// which it is unless `quiet`.
    pub fn plan(&self, quiet: bool) -> Result<Plan, AppError> {
        let plan = |scene: &Scene| Plan::new(scene).map_err(|error| self.refuse(&error));
        let Some(tolerance) = self.auto else { return plan(&self.scene) };
        let chosen = choose(&self.scene, tolerance).map_err(|error| self.refuse(&error))?;
        let Some((method, measurement)) = chosen else {
            return Err(AppError::Target(format!("no integrator keeps positions right to {tolerance:e} m")));
        };
        if !quiet {
            let error = measurement.errors.position;
            say(&format!("integrator {}: off by {error:.1e} m at most", setting(&measurement)));
        }
        plan(&Scene { method: Some(method), ..self.scene.clone() })
    }

    /// The error that a fault found in the whole scene makes, told at its place in the file.
    pub fn refuse(&self, error: &SceneError) -> AppError {
        let problem = Problem::new(error.to_string());
        let mut path: Vec<Step<'_>> = Vec::new();
        match error {
            SceneError::NoBalls => {
                let help = "add [[balls]] with a `position`, or give a list with --balls";
                return self.fail(problem.help(help));
            }
            SceneError::NoExactFlight { .. } => path.extend([Step::Key("method"), Step::Key("integrator")]),
            SceneError::MassMissing { ball, .. } => return self.refuse_ball(*ball, None, problem),
            SceneError::OwnMissing { ball, .. } => {
                let help =
                    "give it a name that the program knows, such as ball = \"tennis\", or `drag` and `restitution`";
                return self.refuse_ball(*ball, None, problem.help(help));
            }
            SceneError::RadiusMissing { ball, .. } => return self.refuse_ball(*ball, None, problem),
            SceneError::RadiusBelowResolution { ball, .. } | SceneError::NoRoom { ball, .. } => {
                return self.refuse_ball(*ball, Some("radius"), problem);
            }
            SceneError::Ball { ball, source } => return self.refuse_ball(*ball, Some(source.name), problem),
            SceneError::Value(value) => path.push(Step::Key(value.name)),
            _ => {}
        }
        self.fail(problem.at(self.source.tree.locate(&path)))
    }

    fn refuse_ball(&self, ball: usize, key: Option<&str>, problem: Problem) -> AppError {
        match &self.balls {
            BallOrigin::Tables(tables) => {
                let mut path = vec![Step::Key("balls"), Step::Index(tables.get(ball).copied().unwrap_or(0))];
                path.extend(key.map(Step::Key));
                self.fail(problem.at(self.source.tree.locate(&path)))
            }
            BallOrigin::List(list) => list.refuse(ball, &problem),
        }
    }

    fn fail(&self, problem: Problem) -> AppError {
        AppError::Scene(findings(&self.source.path, self.source.text.clone(), vec![problem]))
    }
}
