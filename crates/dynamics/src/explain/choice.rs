//! Choosing effects: just those whose omission would change the result by more than a tolerance.
//!
//! From the scene with all effects of the air that its data call for, the smallest is taken out as long as what is then left out, all together, is
//! measured to be within the tolerance. So the choice is verified by what it is made with.

use super::effect::Effect;
use super::{Runs, compare, spread};
use crate::counters::Counters;
use crate::error::SceneError;
use crate::scene::Scene;

/// The effects that are chosen among: the chapter's own are the scene's business.
const OPTIONAL: [Effect; 5] = [Effect::Drag, Effect::Wind, Effect::Magnus, Effect::SpinDecay, Effect::Buoyancy];

/// A scene with the effects it needs, and what that was judged by.
#[derive(Debug, Clone)]
pub struct Choice {
    /// The scene with the effects that were kept.
    pub scene: Scene,
    /// The tolerance: a share of flight times, speeds, and ways.
    pub tolerance: f64,
    /// What was kept, each with the share by which its omission would change a flight or its landing.
    pub kept: Vec<(Effect, f64)>,
    /// What was left out, each with the share that it was measured to change when it was taken out.
    pub left_out: Vec<(Effect, f64)>,
    /// The share by which all that was left out changes a flight or its landing, together.
    pub price: f64,
    /// How often a ball was simulated for the choice.
    pub runs: usize,
    /// What all these runs evaluated.
    pub work: Counters,
}

/// Runs scenes, and counts what that takes.
struct Bench {
    balls: Vec<usize>,
    runs: usize,
    work: Counters,
}

impl Bench {
    fn run(&mut self, scene: Scene) -> Result<Runs, SceneError> {
        let runs = Runs::of(scene, &self.balls)?;
        self.runs += self.balls.len();
        self.work += runs.work().0;
        Ok(runs)
    }

    /// The share by which the flights of two scenes differ.
    fn share(&self, without: &Runs, with: &Runs) -> f64 {
        // Whatever effect it is called by: flights are compared the same.
        compare::find(Effect::Gravity, without, with, &self.balls).map_or(0.0, |finding| finding.share())
    }
}

/// Chooses the effects of `scene`: the laws that it gives, and what its balls are, say how strong they would be. `tolerance` is a share > 0.
pub fn choose(scene: &Scene, tolerance: f64) -> Result<Choice, SceneError> {
    let mut bench = Bench { balls: spread(scene.balls.len()), runs: 0, work: Counters::default() };
    let mut all = scene.clone();
    for effect in OPTIONAL {
        if !effect.is_on(&all)
            && !effect.is_guessed()
            && let Ok((with, _)) = effect.switched(&all)
        {
            all = with;
        }
    }
    let all = bench.run(all)?;
    let mut here = bench.run(all.scene.clone())?;
    let mut choice = Choice {
        scene: scene.clone(),
        tolerance,
        kept: Vec::new(),
        left_out: Vec::new(),
        price: 0.0,
        runs: 0,
        work: bench.work,
    };
    loop {
        // What each would change, were it left out as well.
        let mut without: Vec<(Effect, f64, Runs)> = Vec::new();
        for effect in OPTIONAL.into_iter().filter(|effect| effect.is_on(&here.scene)) {
            if let Ok((scene, _)) = effect.switched(&here.scene) {
                let runs = bench.run(scene)?;
                without.push((effect, bench.share(&runs, &here), runs));
            }
        }
        without.sort_by(|a, b| a.1.total_cmp(&b.1));
        choice.kept = without.iter().map(|(effect, share, _)| (*effect, *share)).collect();
        let least =
            without.into_iter().next().map(|(effect, share, runs)| (effect, share, bench.share(&runs, &all), runs));
        match least {
            Some((effect, share, price, runs)) if share <= tolerance && price <= tolerance => {
                choice.left_out.push((effect, share));
                choice.price = price;
                here = runs;
            }
            _ => break,
        }
    }
    // The method is the scene's, or that of what is left.
    choice.scene = Scene { method: scene.method, ..here.scene };
    choice.kept.reverse();
    Ok(Choice { runs: bench.runs, work: bench.work, ..choice })
}
