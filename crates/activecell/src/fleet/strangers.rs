//! Members of the group, and strangers: which of the things that a robot's sensors meet can be no member.

use crate::error::Error;
use crate::map::{Map, PointM};
use crate::predict::Capsule;
use crate::program::Sensors;
use crate::sense::Estimate;

/// What the group knows of a member: where its body may be, by its own report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemberRecord {
    /// Its body where it reported to be: a disc that holds it, or what the disc sweeps over while it moves from one cell to
    /// the next.
    pub body: Capsule,
    /// How far off the report may be: one standard deviation along the worst axis, as a certificate's waypoint or
    /// [`Estimate::spread_m`] says.
    pub spread_m: f64,
}

/// Something that a beam met and the map does not explain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Which beam met it.
    pub beam: usize,
    /// Where on the floor the beam ended.
    pub at_m: PointM,
    /// How far off that may be: one standard deviation along the worst axis.
    pub spread_m: f64,
}

/// What the beams of a robot met short of the map's obstacles and of their range.
///
/// A beam that ends at an obstacle is taken for something else with a probability of at most `error_rate`: only what is
/// nearer than the obstacle by more than q standard deviations counts, with q as in [`strangers`]. The obstacle is looked
/// for along three beams, as far aside as this one may be, because the beam may pass a corner.
///
/// # Errors
/// [`Error::BadValue`] if the rate is not above 0 and at most 0.5.
pub fn detections(
    map: &Map,
    estimate: &Estimate,
    sensors: &Sensors,
    readings_m: &[f64],
    error_rate: f64,
) -> Result<Vec<Detection>, Error> {
    let far = sigmas(error_rate)?;
    let pose = estimate.pose();
    let beams = sensors.bearings_rad(pose.bearing_rad).zip(readings_m).enumerate();
    let unexplained = beams.filter_map(|(beam, (bearing_rad, &reading_m))| {
        let aside_m = estimate.aside_m(reading_m);
        let spread_m = sensors.noise_m.hypot(aside_m);
        let (sin, cos) = bearing_rad.sin_cos();
        let explained = [-far, 0.0, far].iter().any(|sigmas| {
            let from_m = [pose.at_m[0] - sigmas * aside_m * sin, pose.at_m[1] + sigmas * aside_m * cos];
            map.cast(from_m, bearing_rad, reading_m + far * spread_m).is_some()
        });
        let at_m = [pose.at_m[0] + reading_m * cos, pose.at_m[1] + reading_m * sin];
        (reading_m < sensors.range_m && !explained).then_some(Detection { beam, at_m, spread_m })
    });
    Ok(unexplained.collect())
}

/// The detections that can be no member of the group, by their places in the list.
///
/// **The rule.** A member's body is met on its rim. With normal errors of the detection and of the report, of standard
/// deviations σ₁ and σ₂ at most along any axis and independent of each other, the detection is farther than q √(σ₁² + σ₂²)
/// from the reported body with a probability of at most exp(−q² ÷ 2) (the Rayleigh distribution). With
/// q = √(−2 ln `error_rate`) this is the rate: **a detection of a member is called a stranger with a probability of at
/// most `error_rate`**, whoever the member is. 0.001 makes q = 3.7.
///
/// **What is missed.** A stranger that is met within that distance of a reported body passes for the member. One whose rim
/// is D farther away than that passes with a probability of at most exp(−D² ÷ 2 (σ₁² + σ₂²)). A false reading may be called a
/// stranger at any rate: act on two looks.
///
/// # Errors
/// [`Error::BadValue`] if the rate is not above 0 and at most 0.5.
///
/// ```
/// use activecell::predict::Capsule;
/// use activecell::{Detection, MemberRecord, strangers};
/// let body = Capsule { from_m: [0.0, 0.0], to_m: [1.0, 0.0], radius_m: 0.3 }; // on its way to the next cell
/// let members = [MemberRecord { body, spread_m: 0.03 }];
/// let met = |x, y| Detection { beam: 0, at_m: [x, y], spread_m: 0.04 };
/// // 3.7 standard deviations of 0.05 m together are 0.19 m.
/// assert_eq!(strangers(&members, &[met(0.5, 0.31), met(0.5, 0.48), met(0.5, 0.5), met(3.0, 0.0)], 0.001)?, [2, 3]);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn strangers(
    members: &[MemberRecord],
    detections: &[Detection],
    error_rate: f64,
) -> Result<Vec<usize>, Error> {
    let far = sigmas(error_rate)?;
    let is_stranger = |detection: &Detection| {
        let point = Capsule { from_m: detection.at_m, to_m: detection.at_m, radius_m: 0.0 };
        let is_member = |member: &MemberRecord| {
            member.body.gap_m(&point) <= far * detection.spread_m.hypot(member.spread_m) + 1e-9
        };
        !members.iter().any(is_member)
    };
    Ok((0..detections.len()).filter(|&i| is_stranger(&detections[i])).collect())
}

/// So many standard deviations are exceeded by a deviation in the plane with this probability.
fn sigmas(error_rate: f64) -> Result<f64, Error> {
    if !(error_rate > 0.0 && error_rate <= 0.5) {
        let (name, allowed) = ("the rate of members taken for strangers", "above 0 and at most 0.5");
        return Err(Error::BadValue { name, value: error_rate, allowed });
    }
    Ok((-2.0 * error_rate.ln()).sqrt())
}
