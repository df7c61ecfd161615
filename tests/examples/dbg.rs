//! dbg
use nalgebra::*;
use carom_geometry::{mesh::Mesh, sweep::Work, closest::closest_point};
fn main() {
    let p = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let roof = (vec![p(0.0, -2.0, 0.0), p(0.0, 2.0, 0.0), p(-2.0, 0.0, -2.0), p(2.0, 0.0, -2.0)], vec![[0, 1, 2], [1, 0, 3]]);
    let m = Mesh::new(roof.0, roof.1).unwrap();
    let c = p(-0.1, 0.25, 0.2291287847478007);
    for tol in [1e-15, 1e-14, 1e-13,1e-12] {
    println!("{:?}", m.touches(&c, 0.25, tol, &mut Work::default())); }
    for f in 0..2 { let q = closest_point(&m.triangle(f).map(|v| Point3::from(v - c)), &Point3::origin()); println!("{:?} {:e}", q, q.offset.norm()-0.25); }
}
