//! Hunting for flaws: random scenes of one ball each, by family and seed, each run and checked.

mod scenes;

use crate::checker::{Checker, Flaw};
use crate::obj;
use crate::patience::{Stalled, simulate_within};
use crate::random::Random;
use crate::world::World;
use carom_dynamics::events::{Ending, Outcome};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use carom_geometry::mesh::Mesh;
use scenes::Draft;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The families of scenes: real meshes, triangles anyhow with needles among them, acute wedges, and boxes.
pub const FAMILIES: [&str; 8] = ["spot", "bunny", "stairs", "terrain", "jacksboro", "soup", "wedge", "box"];

/// Stretches of motion after which a ball is taken to hang.
const STRETCHES: u64 = 1_000_000;

/// The meshes, read once.
#[derive(Debug, Clone)]
pub struct Hunt {
    meshes: BTreeMap<&'static str, Arc<Mesh>>,
    worlds: BTreeMap<&'static str, Arc<World>>,
}

/// What came of a ball.
#[derive(Debug, Clone)]
pub struct Run {
    /// The scene.
    pub scene: Scene,
    /// Its events and stretches.
    pub trajectory: Trajectory,
    /// How it ended.
    pub outcome: Outcome,
    /// Each flaw once, with how often and the first of it.
    pub flaws: Vec<String>,
    /// The largest amount of each flaw as a part of what is allowed.
    pub worst: BTreeMap<Flaw, f64>,
}

impl Run {
    /// Whether the ball got to the end without a flaw.
    pub fn is_sound(&self) -> bool {
        self.flaws.is_empty() && self.outcome.ending == Ending::Completed
    }
}

impl Default for Hunt {
    fn default() -> Self {
        let texts = [
            ("spot", include_str!("../../crates/app/scenes/meshes/spot_triangulated.obj")),
            ("bunny", include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj")),
            ("stairs", include_str!("../../crates/app/scenes/meshes/stairs.obj")),
            ("terrain", include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj")),
            ("jacksboro", include_str!("../../crates/app/scenes/meshes/jacksboro_dem_quarter.obj")),
        ];
        let read = |text: &str| {
            let (vertices, faces) = obj::read(text);
            Mesh::new(vertices, faces).unwrap_or_else(|e| panic!("{e}"))
        };
        let meshes: BTreeMap<_, _> = texts.map(|(name, text)| (name, Arc::new(read(text)))).into();
        let worlds = meshes.iter().map(|(&name, mesh)| (name, Arc::new(World::of_mesh(mesh)))).collect();
        Self { meshes, worlds }
    }
}

impl Hunt {
    /// The scene of a family and a seed with its surfaces as the checker sees them; none if the ball found no free place to start.
    pub fn scene(&self, family: &str, seed: u64) -> Option<(Scene, Arc<World>)> {
        let mut random = Random::new(seed.wrapping_mul(0x1234_5678_9abc_def1));
        let draft = Draft::of(family, self.meshes.get(family), &mut random)?;
        // A mesh alone need not be taken apart again.
        let world = match self.worlds.get(family) {
            Some(world) if draft.scene.surfaces.len() == 1 => Arc::clone(world),
            _ => Arc::new(World::of(&draft.scene)),
        };
        draft.place(&world, &mut random).map(|scene| (scene, world))
    }

    /// Runs and checks the ball of a family and a seed; none if it found no free place to start.
    pub fn run(&self, family: &str, seed: u64) -> Result<Option<Run>, Stalled> {
        let Some((scene, world)) = self.scene(family, seed) else { return Ok(None) };
        let plan = Plan::new(&scene).unwrap_or_else(|e| panic!("{family} {seed}: {e}"));
        let ball = &plan.balls()[0];
        let mut trajectory = Trajectory::default();
        let outcome = simulate_within(&plan, ball, &mut trajectory, STRETCHES)?;
        let checker = Checker::run(&world, &scene, ball, &trajectory, &outcome);
        let mut by_flaw: BTreeMap<Flaw, Vec<String>> = BTreeMap::new();
        for f in &checker.findings {
            let what = format!("at t = {} s {:e}, allowed {:e}: {}", f.time, f.amount, f.allowed, f.note);
            by_flaw.entry(f.flaw).or_default().push(what);
        }
        let flaws = by_flaw.iter().map(|(flaw, all)| format!("{flaw:?}, {} times, {}", all.len(), all[0])).collect();
        let worst = checker.worst;
        Ok(Some(Run { scene, trajectory, outcome, flaws, worst }))
    }
}
