//! Scratch.
use carom_dynamics::{
    body::*,
    effects::{friction::*, gravity::*, restitution::*},
    events::*,
    observer::*,
    plan::*,
    scene::*,
    simulate::*,
    surface::*,
};
use carom_geometry::{mesh::*, plane::*, polygon::*};
use nalgebra::*;
use std::sync::Arc;

fn scene(
    shape: Shape,
    e: f64,
    friction: Friction,
    pos: [f64; 3],
    vel: [f64; 3],
    r: f64,
    duration: f64,
    method: Option<Method>,
) -> Scene {
    Scene {
        duration,
        gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81)).unwrap()),
        drag: None,
        surfaces: vec![Surface {
            name: "floor".into(),
            material: Material { restitution: Restitution::new(e).unwrap(), friction },
            shape,
        }],
        balls: vec![Ball::new(pos.into(), vel.into(), r, None).unwrap()],
        rest: None,
        method,
    }
}
fn show(name: &str, scene: &Scene) {
    let plan = Plan::new(scene).unwrap();
    let mut t = Trajectory::default();
    let o = simulate(&plan, &plan.balls()[0], &mut t);
    println!(
        "== {name}: {:?} t={} {:?} x={:?} v={:?}",
        o.ending,
        o.time,
        o.motion,
        o.state.position,
        o.state.velocity.transpose()
    );
    println!("   {:?}", o.counters);
    let n = t.events.len();
    for (i, e) in t.events.iter().enumerate() {
        if i < 4 || i + 6 > n {
            println!(
                "   {:.17} {:?} f={:?} x={:?} n={:?} v {:?} -> {:?}",
                e.time,
                e.kind,
                e.face,
                e.position,
                e.normal.transpose(),
                e.velocity_in.transpose(),
                e.velocity.transpose()
            );
        }
    }
    println!("   {} events, {} segments", n, t.segments.len());
}
#[test]
fn scratch() {
    let floor = || Shape::Plane(Plane::from_point_normal(Point3::origin(), Vector3::z()).unwrap());
    show("drop", &scene(floor(), 0.8, Friction::None, [0., 0., 1.], [0.; 3], 0.0, 10.0, None));
    show(
        "throw coulomb",
        &scene(floor(), 0.7, Friction::coulomb(0.3).unwrap(), [0., 0., 1.], [3., 1., 0.], 0.1, 10.0, None),
    );
    show("e=1", &scene(floor(), 1.0, Friction::None, [0., 0., 1.], [0.; 3], 0.1, 1000.0, None));
    for m in [
        Method::Euler { step: 0.01 },
        Method::SemiImplicitEuler { step: 0.01 },
        Method::Rk4 { step: 0.01 },
        Method::Adaptive { tolerance: 1e-9 },
    ] {
        show(
            &format!("{m:?}"),
            &scene(floor(), 0.7, Friction::coulomb(0.3).unwrap(), [0., 0., 1.], [3., 1., 0.], 0.1, 10.0, Some(m)),
        );
    }
    let tan = 0.4f64;
    let slope = || Shape::Plane(Plane::from_point_normal(Point3::origin(), Vector3::new(tan, 0.0, 1.0)).unwrap());
    show(
        "slope slides",
        &scene(slope(), 0.5, Friction::coulomb(0.3).unwrap(), [0., 0., 1.], [0., 1., 0.], 0.1, 5.0, None),
    );
    show(
        "slope stops",
        &scene(slope(), 0.5, Friction::coulomb(0.6).unwrap(), [0., 0., 1.], [0., 1., 0.], 0.1, 5.0, None),
    );
    // a quad polygon flat
    let quad = || {
        Shape::Polygon(
            Polygon::new([[-1., -1., 0.], [1., -1., 0.], [1., 1., 0.], [-1., 1., 0.]].map(Point3::from).to_vec())
                .unwrap(),
        )
    };
    show("polygon drop on diagonal", &scene(quad(), 0.8, Friction::None, [0.25, 0.25, 1.], [0.; 3], 0.1, 10.0, None));
    show(
        "polygon point",
        &scene(quad(), 0.8, Friction::coulomb(0.2).unwrap(), [0.25, 0.25, 1.], [0.3, 0.1, 0.0], 0.0, 10.0, None),
    );
    show("roll off", &scene(quad(), 0.5, Friction::None, [0.25, 0.3, 1.], [0.5, 0.01, 0.0], 0.1, 10.0, None));
    // box of triangles: valley
    let v = Mesh::new(
        [[-1., -1., 1.], [-1., 1., 1.], [0., -1., 0.], [0., 1., 0.], [1., -1., 1.], [1., 1., 1.]]
            .map(Point3::from)
            .to_vec(),
        vec![[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]],
    )
    .unwrap();
    let v = Arc::new(v);
    show(
        "valley",
        &scene(
            Shape::Mesh(v.clone()),
            0.5,
            Friction::coulomb(0.2).unwrap(),
            [0.3, 0.1, 2.],
            [0.0, 0.05, 0.0],
            0.1,
            20.0,
            None,
        ),
    );
    show(
        "valley point",
        &scene(Shape::Mesh(v), 0.5, Friction::coulomb(0.2).unwrap(), [0.3, 0.1, 2.], [0.0, 0.05, 0.0], 0.0, 20.0, None),
    );
}
