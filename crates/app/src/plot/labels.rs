//! Where the name of a series can stand: beside one of its points, over as little else as possible.

/// A rectangle of the picture, in pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Left and right.
    pub x: [f64; 2],
    /// Top and bottom.
    pub y: [f64; 2],
}

/// Distances between a point and its name, in pixels: beside it, or farther off at the end of a leader.
const GAPS: [f64; 4] = [9.0, 24.0, 42.0, 64.0];

/// Points of a line beside which its name is tried.
const MOST_POINTS: usize = 100;

/// Where a name stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// What it covers.
    pub area: Area,
    /// From the name to its point, if that is farther off.
    pub leader: Option<[[f64; 2]; 2]>,
}

impl Area {
    fn overlaps(&self, other: &Self) -> bool {
        let apart = |a: [f64; 2], b: [f64; 2]| a[1] <= b[0] || b[1] <= a[0];
        !apart(self.x, other.x) && !apart(self.y, other.y)
    }

    fn contains(&self, other: &Self) -> bool {
        let within = |a: [f64; 2], b: [f64; 2]| a[0] <= b[0] && b[1] <= a[1];
        within(self.x, other.x) && within(self.y, other.y)
    }

    /// Whether the line from `a` to `b` comes into it (Liang and Barsky).
    fn is_crossed(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (range, axis) in [(self.x, 0), (self.y, 1)] {
            let d = b[axis] - a[axis];
            for (limit, sign) in [(range[0], -1.0), (range[1], 1.0)] {
                let (p, q) = (sign * d, sign * (limit - a[axis]));
                if p == 0.0 && q < 0.0 {
                    return false;
                }
                if p < 0.0 {
                    from = from.max(q / p);
                } else if p > 0.0 {
                    to = to.min(q / p);
                }
            }
        }
        from <= to
    }
}

/// The places of names of `sizes` (width, height) beside the points of their `lines`, inside `frame` and off `taken`.
///
/// The names with the fewest points choose first; each takes the place that covers least, and of those the nearest one, as near as can be to
/// the end of its line.
pub fn place(sizes: &[[f64; 2]], lines: &[Vec<[f64; 2]>], frame: Area, taken: &[Area]) -> Vec<Option<Place>> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&k| (lines[k].len(), k));
    let mut taken = taken.to_vec();
    let mut places = vec![None; sizes.len()];
    for k in order {
        let [width, height] = sizes[k];
        if width == 0.0 {
            continue;
        }
        let mut best: Option<(u32, Place)> = None;
        // Of a line with thousands of points the places beside a hundred of them are as good, and found in no time.
        let stride = lines[k].len().div_ceil(MOST_POINTS).max(1);
        for (from_end, &[x, y]) in lines[k].iter().rev().step_by(stride).enumerate() {
            let near = from_end.min(50) as u32;
            for (turn, [dx, dy]) in SIDES.into_iter().enumerate() {
                for (far, gap) in GAPS.into_iter().enumerate() {
                    let left = x + dx * gap - width * 0.5 * (1.0 - dx);
                    let top = y + dy * gap - height * 0.5 * (1.0 - dy);
                    let area = Area { x: [left, left + width], y: [top, top + height] };
                    let (end, start) = ([x + dx * (gap - 2.0), y + dy * (gap - 2.0)], [x + dx * 6.0, y + dy * 6.0]);
                    let leader = (far > 0).then_some([start, end]);
                    let crossed = leader.map_or(0, |[a, b]| taken.iter().filter(|t| t.is_crossed(a, b)).count() as u32);
                    let cost =
                        covered(&area, lines, &taken, &frame) + 2000 * crossed + 20 * far as u32 + near + turn as u32;
                    if best.is_none_or(|(least, _)| cost < least) {
                        best = Some((cost, Place { area, leader }));
                    }
                }
            }
        }
        if let Some((_, place)) = best {
            taken.push(place.area);
            places[k] = Some(place);
        }
    }
    places
}

/// Where a name may stand as seen from its point: right, above, below, left, and the corners.
const SIDES: [[f64; 2]; 8] =
    [[1.0, 0.0], [0.0, -1.0], [0.0, 1.0], [-1.0, 0.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0]];

/// How bad it would be to write there.
fn covered(area: &Area, lines: &[Vec<[f64; 2]>], taken: &[Area], frame: &Area) -> u32 {
    let names = taken.iter().filter(|other| area.overlaps(other)).count() as u32;
    let outside = u32::from(!frame.contains(area));
    // Lines and marks have a width.
    let near = Area { x: [area.x[0] - 5.0, area.x[1] + 5.0], y: [area.y[0] - 3.0, area.y[1] + 3.0] };
    let mut strokes = 0;
    for line in lines {
        let dots = line.iter().filter(|p| near.is_crossed(**p, **p)).count();
        let pieces = line.windows(2).filter(|p| near.is_crossed(p[0], p[1])).count();
        strokes += (dots + pieces) as u32;
    }
    1_000_000 * outside + 10_000 * names + 100 * strokes.min(90)
}
