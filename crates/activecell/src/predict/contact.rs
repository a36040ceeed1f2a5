//! The checker of a drive past moving objects; it knows no plan, no track and no slot.

use crate::map::PointM;

/// When and where a robot touched an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The first time of contact, to within the parts in which the ways are looked at.
    pub time_s: f64,
    /// The robot's centre then.
    pub robot_m: PointM,
    /// The object's centre then.
    pub object_m: PointM,
}

/// Finds the first contact of two discs that both move on straight lines between timed points: `(time, centre)`, times
/// growing. Exact: between two times each pair of lines is solved for its nearest approach. Compared are the times
/// that both cover.
///
/// ```
/// use activecell::predict::first_contact;
/// let robot = [(0.0, [0.0, 0.0]), (4.0, [4.0, 0.0])];
/// let object = [(0.0, [2.0, 2.0]), (4.0, [2.0, -2.0])];
/// let contact = first_contact(&robot, &object, 0.5).expect("both reach (2, 0) at 2 s");
/// assert!((contact.time_s - (2.0 - 0.5 / 2f64.sqrt())).abs() < 1e-9);
/// assert!(first_contact(&robot, &[(0.0, [2.0, 2.0]), (4.0, [2.0, 1.0])], 0.5).is_none());
/// ```
pub fn first_contact(
    robot: &[(f64, PointM)],
    object: &[(f64, PointM)],
    both_radii_m: f64,
) -> Option<Contact> {
    let times = || robot.iter().chain(object).map(|point| point.0);
    let mut times: Vec<f64> = times().collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let from = robot.first()?.0.max(object.first()?.0);
    let to = robot.last()?.0.min(object.last()?.0);
    times.retain(|time| (from..=to).contains(time));
    if let [only] = times[..] {
        times.push(only);
    }
    times.windows(2).find_map(|span| {
        let (begin, end) = (span[0], span[1]);
        let ends = [at(robot, begin), at(robot, end), at(object, begin), at(object, end)];
        let share = touch([minus(ends[0], ends[2]), minus(ends[1], ends[3])], both_radii_m)?;
        let time_s = begin + (end - begin) * share;
        let between = |a: PointM, b: PointM| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share);
        Some(Contact { time_s, robot_m: between(ends[0], ends[1]), object_m: between(ends[2], ends[3]) })
    })
}

fn minus(a: PointM, b: PointM) -> PointM {
    [a[0] - b[0], a[1] - b[1]]
}

/// Where on its way a disc is at a time within it.
fn at(way: &[(f64, PointM)], time_s: f64) -> PointM {
    let after = way.partition_point(|point| point.0 < time_s).min(way.len() - 1);
    let ((t0, a), (t1, b)) = (way[after.saturating_sub(1)], way[after]);
    let share = if t1 > t0 { ((time_s - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}

/// The first share of a straight way at which it is within `radius` of the origin: a root of |a + (b − a) s|² = r².
fn touch([a, b]: [PointM; 2], radius: f64) -> Option<f64> {
    let d = minus(b, a);
    let (square, along) = (d[0] * d[0] + d[1] * d[1], a[0] * d[0] + a[1] * d[1]);
    let beyond = a[0] * a[0] + a[1] * a[1] - radius * radius;
    if beyond < 0.0 {
        return Some(0.0);
    }
    let root = along * along - square * beyond;
    if root <= 0.0 || along >= 0.0 {
        return None;
    }
    let share = (-along - root.sqrt()) / square;
    (share <= 1.0).then_some(share)
}
