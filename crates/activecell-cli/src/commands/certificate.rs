//! The certificate as `route --robot` tells it.

use activecell::{Certificate, Fixes, Map, Method, Program, Region, Robot, Trust};
use activecell_formats::certificate::CertificateReport;

/// How many fixes are printed for people.
const PRINTED_FIXES: usize = 8;

/// The column heads that [`Certified::columns`] stands under.
pub(super) const COLUMN_HEADS: &str = "    ± 95 %    inside";

/// A certificate, and the fixes that keep the robot above a threshold.
pub(super) struct Certified {
    certificate: Certificate,
    fixes: Fixes,
    threshold: f64,
}

impl Certified {
    pub(super) fn new(map: &Map, robot: &Robot, program: &Program, threshold: f64) -> Self {
        let certificate = Certificate::new(map, robot, program);
        Self { certificate, fixes: Fixes::new(map, robot, program, threshold), threshold }
    }

    pub(super) fn report(&self) -> CertificateReport {
        CertificateReport::new(&self.certificate, &self.fixes, self.threshold)
    }

    pub(super) fn regions(&self) -> Vec<Region> {
        self.certificate.waypoints().iter().map(Trust::region).collect()
    }

    /// Half the length of the region, and the probability of being inside, at one entry of M.
    pub(super) fn columns(&self, waypoint: usize) -> String {
        self.certificate.waypoints().get(waypoint).map_or_else(String::new, |trust| {
            format!("{:>8.3} m {:>7.1} %", trust.region().semi_major_m, assured(trust.inside))
        })
    }

    /// The summary for people.
    pub(super) fn text(&self) -> String {
        let wanted = percent(self.threshold);
        let mut text = String::new();
        if let Some(worst) = self.certificate.worst() {
            text += &format!("inside its cell: {:.1} % at worst, at {}", assured(worst.inside), worst.cell);
            text += &match self.certificate.first_below(self.threshold) {
                Some(first) => format!("; first below {wanted} % at {}\n", first.cell),
                None => format!("; nowhere below {wanted} %\n"),
            };
        }
        if let Some(first) = self.certificate.waypoints().iter().find(|trust| trust.method == Method::Sampled)
        {
            text +=
                &format!("from {} on the errors are too large for formulas, and were sampled\n", first.cell);
        }
        let Fixes { fixes, not_enough_at } = &self.fixes;
        let cells: Vec<String> = fixes.iter().take(PRINTED_FIXES).map(|fix| fix.cell.to_string()).collect();
        let more = if fixes.len() > PRINTED_FIXES { " …" } else { "" };
        let listed = format!("{}, at {}{more}", fixes.len(), cells.join(" "));
        text += &match (not_enough_at, fixes.is_empty()) {
            (None, true) => format!("position fixes that keep it at {wanted} %: none needed\n"),
            (None, false) => format!("position fixes that keep it at {wanted} %: {listed}\n"),
            (Some(cell), true) => format!("no position fix keeps it at {wanted} % in {cell}\n"),
            (Some(cell), false) => {
                format!("position fixes that keep it at {wanted} %: {listed}; but none does in {cell}\n")
            }
        };
        text
    }
}

/// A probability in percent, rounded down to a tenth: what is printed is never more than what is certified. (It is right
/// to 1e-6.)
fn assured(probability: f64) -> f64 {
    ((probability + 1e-6) * 1000.0).floor() / 10.0
}

fn percent(share: f64) -> f64 {
    100.0 * share
}
