//! The loop asks for no memory: what a run asks for is for its lists, once, however long it is.

use carom_dynamics::plan::Plan;
use carom_dynamics::simulate::simulate;
use carom_tests::obj;
use carom_tests::stage::{Stage, coulomb, rough, smooth};

const TERRAIN: &str = include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj");

/// How often a run of the only ball of `plan` asks for memory, and how many impacts it has.
fn asked_for(plan: &Plan) -> (u64, u64) {
    let mut impacts = 0;
    let asked = allocation_counter::measure(|| impacts = simulate(plan, &plan.balls()[0], &mut ()).counters.impacts);
    (asked.count_total, impacts)
}

/// How much more often in the run that is `longer`, which has that many impacts more.
fn more(stage: impl Fn(f64) -> Stage, [short, longer]: [f64; 2]) -> (u64, u64) {
    let [short, longer] = [short, longer].map(|duration| asked_for(&stage(duration).plan()));
    (longer.0 - short.0, longer.1 - short.1)
}

#[test]
fn among_planes_nothing_is_asked_for() {
    let room = |duration| {
        Stage::new(duration).down(9.81).room(rough(1.0, coulomb(0.1)), [3.0, 4.0, 2.5]).ball(
            [1.0, 1.5, 1.25],
            [30.0, 20.0, 10.0],
            0.05,
        )
    };
    let (asked, impacts) = more(room, [1.0, 100.0]);
    assert!(asked == 0 && impacts > 100, "{asked} times in {impacts} impacts");
}

#[test]
fn on_a_mesh_lists_grow_to_their_greatest_length_and_no_further() {
    let (mut vertices, faces) = obj::read(TERRAIN);
    vertices.iter_mut().for_each(|v| v.z += 1.0);
    let terrain = |duration| {
        Stage::new(duration)
            .down(9.81)
            .mesh("terrain", smooth(1.0), vertices.clone(), faces.clone())
            .room(smooth(1.0), [13.0, 13.0, 60.0])
            .ball([6.0, 7.0, 5.0], [3.0, 2.0, 0.0], 0.3)
    };
    let (asked, impacts) = more(terrain, [20.0, 2000.0]);
    // A list that doubles its length grows from 4 to 2^16 in 14 steps.
    assert!(asked <= 14 && impacts > 1000, "{asked} times in {impacts} impacts");
}
