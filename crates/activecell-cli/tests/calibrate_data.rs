//! Calibration on a real robot's logs (the `OptiOdom` data set): what half of the sessions tell holds on the others.
//!
//! The folder is that of `ACTIVECELL_DATA`, else `shared/data` beside the project; where it is missing the tests say
//! so and pass.

#![expect(clippy::unwrap_used, reason = "a test that cannot read its logs should stop")]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The folders of the sessions, by path.
fn sessions() -> Option<Vec<PathBuf>> {
    let root = std::env::var_os("ACTIVECELL_DATA").map_or(project().join("../shared/data"), PathBuf::from);
    let folder = root.join("odometry/optiodom");
    if !folder.is_dir() {
        println!("SKIPPED: {} was not found; the fit was not tried on real logs", folder.display());
        return None;
    }
    let inside = |folder: PathBuf| {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut folders: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
        folders.sort();
        folders
    };
    Some(inside(folder).into_iter().flat_map(inside).collect())
}

fn calibrate(arguments: &[&str], fitted: &[&PathBuf], held_out: &[&PathBuf]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_activecell"));
    command.arg("calibrate").args(arguments).args(fitted);
    if !held_out.is_empty() {
        command.arg("--hold-out").args(held_out);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn what_half_of_the_sessions_tell_holds_on_the_others() {
    let Some(sessions) = sessions() else { return };
    let half = |rest: usize| -> Vec<&PathBuf> {
        sessions.iter().enumerate().filter(|(i, _)| i % 2 == rest).map(|(_, session)| session).collect()
    };
    // Every other session by path; then the other way round.
    for (fitted, others) in [(half(0), half(1)), (half(1), half(0))] {
        let report: Value = serde_json::from_str(&calibrate(&["--json"], &fitted, &others)).unwrap();
        let rows = report["rows"].as_array().unwrap();
        let number = |row: &Value, key: &str| row[key].as_f64().unwrap();
        let mut long: Vec<f64> = rows
            .iter()
            .filter(|row| number(row, "way_m") >= 5.0)
            .map(|row| number(row, "nominal_m") / number(row, "calibrated_m"))
            .collect();
        long.sort_by(f64::total_cmp);
        let long_falls = long[(long.len() - 1) / 2];
        let worst_falls = report["worst_end_error_falls"].as_f64().unwrap();
        let inside = report["inside"].as_u64().unwrap() as usize;
        let median_falls = report["median_end_error_falls"].as_f64().unwrap();
        println!(
            "fitted on {} logs: the median end error falls {median_falls:.1} times, the worst end error of a session falls {worst_falls:.1} times (median), that of the {} logs of 5 m and more {long_falls:.1} times, in the median of all {} logs it falls {:.1} times; {inside} inside",
            report["logs"],
            long.len(),
            rows.len(),
            report["end_error_falls"].as_f64().unwrap()
        );
        assert!(median_falls >= 2.0 && worst_falls >= 2.0 && long_falls >= 2.0);
        assert!(inside * 10 >= rows.len() * 9);
    }
}

#[test]
fn the_document_shows_what_the_command_prints() {
    let Some(sessions) = sessions() else { return };
    let all: Vec<&PathBuf> = sessions.iter().collect();
    let document = std::fs::read_to_string(project().join("docs/calibration.md")).unwrap();
    let report = calibrate(&[], &all, &[]);
    println!("{report}");
    assert!(document.contains(report.trim_end()), "docs/calibration.md shows other figures; copy these");
}
