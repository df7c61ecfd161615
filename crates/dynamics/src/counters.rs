//! Work counts: deterministic, unlike time.

use carom_geometry::sweep::Work;

/// What a run evaluated. Counts add up over balls and do not depend on the machine or the number of threads.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counters {
    /// Paths made by the integrator or by a contact motion.
    pub paths: u64,
    /// Clearances of a path from a plane that were solved for their first entry.
    pub clearances: u64,
    /// Nodes of bounding-volume trees that were visited.
    pub nodes: u64,
    /// Triangles that the tree let through.
    pub triangles: u64,
    /// Support-plane rounds spent on those triangles.
    pub rounds: u64,
    /// Evaluations of the acceleration.
    pub accelerations: u64,
    /// Evaluations of drag.
    pub drag: u64,
    /// Evaluations of the Magnus force.
    pub magnus: u64,
    /// Evaluations of restitution.
    pub restitution: u64,
    /// Evaluations of friction.
    pub friction: u64,
    /// Evaluations of the rest test.
    pub rest: u64,
    /// Impacts answered (a simultaneous one at several surfaces counts once).
    pub impacts: u64,
    /// Hit positions put back onto the surface within the rounding bound.
    pub corrections: u64,
    /// Steps halved because a hop was too short for them.
    pub halvings: u64,
}

impl Counters {
    /// Adds what a query of a mesh looked at.
    pub(crate) fn add(&mut self, work: &Work) {
        self.nodes += work.nodes;
        self.triangles += work.triangles;
        self.rounds += work.rounds;
    }
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, o: Self) {
        self.paths += o.paths;
        self.clearances += o.clearances;
        self.nodes += o.nodes;
        self.triangles += o.triangles;
        self.rounds += o.rounds;
        self.accelerations += o.accelerations;
        self.drag += o.drag;
        self.magnus += o.magnus;
        self.restitution += o.restitution;
        self.friction += o.friction;
        self.rest += o.rest;
        self.impacts += o.impacts;
        self.corrections += o.corrections;
        self.halvings += o.halvings;
    }
}

impl Counters {
    /// Every count with its name.
    pub fn named(&self) -> [(&'static str, u64); 14] {
        // Taken apart, so that a new count cannot be forgotten here.
        let Self {
            paths,
            clearances,
            nodes,
            triangles,
            rounds,
            accelerations,
            drag,
            magnus,
            restitution,
            friction,
            rest,
            impacts,
            corrections,
            halvings,
        } = *self;
        [
            ("paths", paths),
            ("clearances", clearances),
            ("nodes", nodes),
            ("triangles", triangles),
            ("rounds", rounds),
            ("accelerations", accelerations),
            ("drag", drag),
            ("magnus", magnus),
            ("restitution", restitution),
            ("friction", friction),
            ("rest", rest),
            ("impacts", impacts),
            ("corrections", corrections),
            ("halvings", halvings),
        ]
    }
}
