//! From the keys of `[air]` to what the air does.

use super::build::{Builder, at};
use super::file::{AirTable, DragLaw, DragOf, DragTable};
use super::problem::Problem;
use carom_dynamics::effects::buoyancy::Buoyancy;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::magnus::Magnus;
use carom_dynamics::effects::spin_decay::SpinDecay;
use nalgebra::Vector3;

/// What the air does to the balls.
#[derive(Debug, Default)]
pub struct Air {
    pub drag: Option<Drag>,
    pub magnus: Option<Magnus>,
    pub spin_decay: Option<SpinDecay>,
    pub buoyancy: Option<Buoyancy>,
}

const LAWS: &str =
    "drag = { linear = k } in kg/s, drag = { coefficient = C, density = rho }, drag = \"ball\" or drag = \"sphere\"";

/// What to say where a density is missing.
const DENSITY: &str = "add `density` to [air]: 1.204 kg/m^3 at 20 C";

impl Builder<'_> {
    /// The effects of the air.
    pub fn air(&mut self, air: &AirTable) -> Air {
        if let Some(density) = air.density
            && !(density.is_finite() && density >= 0.0)
        {
            let message = format!("density is {density:?}, but must be finite and >= 0, in kg/m^3");
            self.refuse(at!["air", "density"], Problem::new(message));
            return Air::default();
        }
        if air.wind.is_some() && air.drag.is_none() && air.magnus.is_none() {
            let problem = Problem::new("wind without a drag law does nothing");
            self.refuse(at!["air", "wind"], problem.help(format!("add {LAWS}, or leave `wind` out")));
        }
        let wind = air.wind.map(Vector3::from);
        let drag = air.drag.as_ref().and_then(|drag| self.drag(drag, air));
        let drag = match wind {
            Some(wind) => drag.and_then(|d| self.accept(at!["air", "wind"], d.in_wind(wind))),
            None => drag,
        };
        let spin_decay = air.spin_decay.and_then(|tau| self.accept(at!["air", "spin_decay"], SpinDecay::new(tau)));
        let buoyancy = air.buoyancy.unwrap_or(false).then(|| self.density(air, "buoyancy")).flatten();
        let buoyancy = buoyancy.and_then(|density| self.accept(at!["air", "density"], Buoyancy::new(density)));
        Air { drag, magnus: self.magnus(air, wind), spin_decay, buoyancy }
    }

    fn drag(&mut self, drag: &DragTable, air: &AirTable) -> Option<Drag> {
        let table = match drag {
            DragTable::Law(table) => table,
            DragTable::Of(DragOf::Ball) => {
                let density = self.density(air, "drag")?;
                return self.accept(at!["air", "density"], Drag::of_ball(density));
            }
            DragTable::Of(DragOf::Sphere) => {
                let density = self.density(air, "drag")?;
                let Some(viscosity) = air.viscosity else {
                    let problem = Problem::new("the drag of a smooth sphere needs the viscosity of the air");
                    self.refuse(at!["air", "drag"], problem.help("add `viscosity` to [air]: 1.825e-5 Pa s at 20 C"));
                    return None;
                };
                return self.accept(at!["air", "viscosity"], Drag::sphere(density, viscosity));
            }
        };
        match *table {
            DragLaw { linear: Some(k), coefficient: None, density: None } => {
                self.accept(at!["air", "drag", "linear"], Drag::linear(k))
            }
            DragLaw { linear: None, coefficient: Some(coefficient), density } if density.or(air.density).is_some() => {
                let drag = Drag::quadratic(coefficient, density.or(air.density).unwrap_or(0.0));
                let key = if drag.is_err_and(|e| e.name.contains("density")) { "density" } else { "coefficient" };
                self.accept(at!["air", "drag", key], drag)
            }
            DragLaw { linear: None, coefficient: Some(_), .. } | DragLaw { linear: None, density: Some(_), .. } => {
                let problem = Problem::new("quadratic drag needs both `coefficient` and `density`");
                self.refuse(at!["air", "drag"], problem.help("about 0.47 for a sphere, and 1.204 kg/m^3 at 20 C"));
                None
            }
            _ => {
                self.refuse(at!["air", "drag"], Problem::new("drag needs exactly one law").help(LAWS));
                None
            }
        }
    }

    fn magnus(&mut self, air: &AirTable, wind: Option<Vector3<f64>>) -> Option<Magnus> {
        let table = air.magnus.as_ref()?;
        let density = match table.density {
            Some(density) => density,
            None => self.density(air, "magnus")?,
        };
        let magnus = Magnus::new(table.coefficient, density);
        let key = if magnus.is_err_and(|e| e.name.contains("density")) { "density" } else { "coefficient" };
        let magnus = self.accept(at!["air", "magnus", key], magnus)?;
        match wind {
            // A wind that is none is told where the drag meets it.
            Some(wind) => magnus.in_wind(wind).ok(),
            None => Some(magnus),
        }
    }

    /// The density of the air, which `key` asks for.
    fn density(&mut self, air: &AirTable, key: &str) -> Option<f64> {
        if air.density.is_none() {
            self.refuse(at!["air", key], Problem::new(format!("`{key}` needs the density of the air")).help(DENSITY));
        }
        air.density
    }
}
