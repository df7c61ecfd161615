//! exploratory
use carom_geometry::closest::Feature;
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::path::Path;
use carom_geometry::rounding::{contact_bound, point_radius, UNIT_ROUNDOFF};
use carom_tests::data::{csv, number};
use carom_tests::exact;
use nalgebra::{Point3, Vector3};

const HEADER: &str = "id,category,cx,cy,cz,vx,vy,vz,gx,gy,gz,r,ax,ay,az,bx,by,bz,ex,ey,ez,tmax,start,hit,t_lo,t_hi,t_decimal,feature,multiplicity,n_boundary_roots";

#[test]
fn explore() {
    let rows = csv("geometry-cases/ball_vs_triangle_exact.csv", HEADER);
    for scaled in [false, true] {
    for row in &rows {
        let n = |i: usize| number(&row[i]);
        let p = |i: usize| Point3::new(n(i), n(i + 1), n(i + 2));
        let v = |i: usize| Vector3::new(n(i), n(i + 1), n(i + 2));
        let tri = [p(12), p(15), p(18)];
        let tmax = n(21);
        let (r0, hit, start) = (n(11), &row[23] == "1", row[22].as_str());
        let unit = if scaled { tmax } else { 1.0 };
        let terms = [v(5) * unit, v(8) * 0.5 * unit * unit];
        let path = Path::parabola(p(2), terms[0], terms[1]);
        let to = if scaled { 1.0 } else { tmax };
        let far = tri.iter().map(|q| q.coords.amax()).fold(0.0, f64::max);
        let r = if r0 == 0.0 { point_radius(far) } else { r0 };
        let ball = MovingBall { path: &path, radius: r, holds: &[] };
        let mut rounds = 0;
        let got = first_contact(&ball, &tri, 0.0, to, &mut rounds);
        let size = tri.iter().map(|q| (q - p(2)).amax()).fold(r, f64::max);
        let label = format!("{} {} {} r={} hit={} mult={} scaled={scaled} rounds={rounds}", row[0], row[1], start, r0, hit, row[28]);
        match got {
            Contact::Miss => if hit { println!("MISSED {label}  t={}", row[24]) },
            Contact::At { f, feature } => {
                let x = exact::on_path(&p(2), &terms, f);
                let bound = contact_bound(size + path.reach(f));
                let gap = exact::clearance(&tri, &x, r) / bound;
                if !hit { println!("FALSE {label} f={f} gap={gap:.3} bound {bound:e}"); continue; }
                if start != "outside" { println!("START {label} f={f} t={}", row[24]); continue; }
                let (lo, hi) = (n(24) / unit, n(25) / unit);
                let late = (f - hi) / hi / UNIT_ROUNDOFF;
                let early = (lo - f) / lo / UNIT_ROUNDOFF;
                println!("HIT {label} late={late:.2} early={early:.3} gap={gap:.4} {feature:?} {}", row[27]);
            }
        }
    }
    }
}
