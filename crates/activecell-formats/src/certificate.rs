//! The certificate as the route's report holds it.

use activecell::{Cell, Certificate, Fixes, Trust};
use serde::Serialize;

/// How far the robot can be trusted.
#[derive(Debug, Clone, Serialize)]
pub struct CertificateReport {
    /// The probability below which the robot is not trusted to be in its cell.
    pub threshold: f64,
    /// The waypoint where it is least likely there.
    pub worst: Option<InsideReport>,
    /// The first waypoint below the threshold; null if there is none.
    pub first_below: Option<InsideReport>,
    /// Where position and heading must be fixed for the robot to stay above the threshold in every cell.
    pub fixes: Vec<FixReport>,
    /// The first cell where not even a fix in the cell before is enough, as [x, y]; null if there is none.
    pub fixes_not_enough_at: Option<[i32; 2]>,
    /// One for each entry of M.
    pub waypoints: Vec<TrustReport>,
}

/// A cell and the probability that the robot is inside.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct InsideReport {
    /// Column.
    pub x: i32,
    /// Row.
    pub y: i32,
    /// Probability.
    pub inside: f64,
}

/// A fix of position and heading.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct FixReport {
    /// Column.
    pub x: i32,
    /// Row.
    pub y: i32,
    /// After so many steps.
    pub step: usize,
}

/// How far the robot can be trusted at one entry of M.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct TrustReport {
    /// Column.
    pub x: i32,
    /// Row.
    pub y: i32,
    /// The probability that the robot's centre is in that cell.
    pub inside: f64,
    /// The ellipse in which it is with 95 %.
    pub region: RegionReport,
    /// One standard deviation of its heading.
    pub heading_deviation_rad: f64,
    /// `closed_form` or `sampled`.
    pub method: &'static str,
}

/// An ellipse on the floor.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RegionReport {
    /// Its middle.
    pub centre_m: [f64; 2],
    /// Half its length.
    pub semi_major_m: f64,
    /// Half its width.
    pub semi_minor_m: f64,
    /// The direction of its length, counter-clockwise from the x axis.
    pub angle_rad: f64,
}

impl CertificateReport {
    /// The report of a certificate and of the fixes planned for the same threshold.
    pub fn new(certificate: &Certificate, fixes: &Fixes, threshold: f64) -> Self {
        let inside = |trust: &Trust| InsideReport { x: trust.cell.x, y: trust.cell.y, inside: trust.inside };
        let fix = |fix: &activecell::Fix| FixReport { x: fix.cell.x, y: fix.cell.y, step: fix.step };
        Self {
            threshold,
            worst: certificate.worst().map(inside),
            first_below: certificate.first_below(threshold).map(inside),
            fixes: fixes.fixes.iter().map(fix).collect(),
            fixes_not_enough_at: fixes.not_enough_at.map(|cell: Cell| [cell.x, cell.y]),
            waypoints: certificate.waypoints().iter().map(TrustReport::new).collect(),
        }
    }
}

impl TrustReport {
    fn new(trust: &Trust) -> Self {
        let region = trust.region();
        Self {
            x: trust.cell.x,
            y: trust.cell.y,
            inside: trust.inside,
            region: RegionReport {
                centre_m: region.centre_m,
                semi_major_m: region.semi_major_m,
                semi_minor_m: region.semi_minor_m,
                angle_rad: region.angle_rad,
            },
            heading_deviation_rad: trust.heading_deviation_rad,
            method: trust.method.name(),
        }
    }
}
