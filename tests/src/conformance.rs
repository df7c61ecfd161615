//! The conformance pack: hard cases and closed forms as scenes with the events they must have, for any engine.

mod bouncing;
mod drag;
mod edges;
mod pack;
mod sliding;
mod walls;

pub use pack::{Pack, Target};

/// Every case, by name.
pub fn all() -> Vec<Pack> {
    let pieces = [bouncing::packs(), walls::packs(), edges::packs(), sliding::packs(), drag::packs()];
    let mut all: Vec<Pack> = pieces.into_iter().flatten().collect();
    all.sort_by_key(|pack| pack.name);
    all
}

/// Every file of the folder `conformance`: its path in the folder, and what is in it.
pub fn files() -> Vec<(String, String)> {
    let all = all();
    let mut files = vec![("README.md".to_owned(), readme(&all))];
    for pack in &all {
        files.push((format!("scenes/{}.toml", pack.name), pack.scene_file()));
        files.push((format!("expected/{}.csv", pack.name), pack.expected_file()));
        files.extend(pack.meshes.iter().map(|(name, text)| (format!("scenes/{name}"), text.clone())));
    }
    files.sort();
    files.dedup();
    files
}

fn readme(all: &[Pack]) -> String {
    let mut text = README.to_owned();
    text += "| case | what | targets | source |\n|---|---|--:|---|\n";
    for pack in all {
        let (name, targets) = (pack.name, pack.targets.len());
        text += &format!("| [{name}](scenes/{name}.toml) | {} | {targets} | {} |\n", pack.title, pack.source);
    }
    text
}

const README: &str = "\
# Conformance pack

Scenes of bouncing balls whose events are known in closed form, with a tolerance for each, so that any engine can be held against
them. `cargo xtask conformance` writes this folder; nothing in it is written by hand.

- `scenes/NAME.toml`: the scene, in SI units. The keys are described by `carom schema`: what there is to know is the gravity, the air,
  the materials (restitution e; friction by name), the surfaces (planes, polygons, meshes in OBJ files beside the scene) and the balls.
  A ball of radius 0 is a point. Balls do not rotate and do not meet each other.
- `expected/NAME.csv`: the targets, one a line. Lines that begin with `#` are comments.

| column | meaning |
|---|---|
| `ball` | the ball, from 0, in the order of the scene |
| `kind` | `impact`, `slide` (bouncing has ended, sliding begins), `rest`, `leave`, `wake`; or `impacts` for the number of impacts in all |
| `n` | the n-th event of that kind of that ball, from 1; behind `impacts`, how many there are. Impacts of a ball at one time are one |
| `t` | when, in s |
| `x,y,z` | where the ball's centre is, in m; an empty cell is not compared |
| `vx,vy,vz` | its velocity just afterwards, in m/s |
| `dt,dx,dv` | how far time (s), place (m, Euclidean) and velocity (m/s, Euclidean) may be off; what has no tolerance is not compared |

The tolerances are what double precision allows, times a small number: they are hard. To compare, write the events of your engine
as CSV with the columns `t,ball,kind,x,y,z,vx,vy,vz` (more do not matter) and run

```sh
carom compare conformance/expected/corner.csv corner.csv
carom compare --loosen 1e6 conformance/expected/corner.csv corner.csv
```

which prints the worst deviations, and ends with 5 if a target is not met. `--loosen` multiplies every tolerance.

";
