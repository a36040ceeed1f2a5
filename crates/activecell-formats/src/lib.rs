//! Files of activecell: bytes ⇄ values.
//!
//! | module | files |
//! |---|---|
//! | [`ros`] | ROS `map_server`: a YAML file and an image |
//! | [`movingai`] | `MovingAI` benchmarks: `.map` and `.scen` |
//! | [`raster`] | images: PNG, PGM, PPM |
//! | [`elevation`] | heights of the ground: ESRI ASCII grid, `GeoTIFF`, gray PNG, `NumPy` |
//! | [`robot`] | robots: TOML |
//! | [`drive_log`] | encoder logs with ground truth: CSV |
//! | [`calibration`] | what a calibration found: JSON |
//! | [`run`] | routes and runs: JSON |
//! | [`certificate`] | certificates, in the routes' JSON |
//! | [`plan`] | plans of groups: the text that MAPF tools share, JSON, paths |
//! | [`fleet`] | reports on groups and their plans: JSON |
//! | [`lorr`] | lifelong tasks of the League of Robot Runners: JSON, lists, CSV |
//! | [`sizes`] | sizes of a group's robots: text |
//! | [`strangers`] | what a group keeps out of: JSON |
//! | [`schedule`] | schedules of plans, and what their execution came to: JSON |
//! | [`trace`] | what simulated robots did: JSON |
//! | [`files`] | the disk: which format a path has, reading with limits, writing as a whole |
//!
//! Everything but [`files`] works on bytes in memory. Input is never trusted: sizes that a header declares are
//! compared with the bytes at hand before memory is taken, and every [`Error`] is one line that says where,
//! what is wrong, and what to do.
//!
//! ```
//! use activecell_formats::files::{self, ReadOptions};
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("office.yaml");
//! # let map = activecell::Map::parse(activecell::Lattice::Square, "..#\n#..").map_err(activecell_formats::Error::from)?;
//! files::write_map(&path, &map)?; // office.pgm and office.yaml
//! let (same, _format) = files::read_map(&path, &ReadOptions::default())?;
//! assert_eq!(same, map);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod calibration;
pub mod certificate;
pub mod drive_log;
pub mod elevation;
mod error;
pub mod files;
pub mod fleet;
pub mod lifelong;
mod lines;
pub mod lorr;
pub mod movingai;
pub mod plan;
pub mod raster;
mod read_run;
pub mod robot;
pub mod ros;
pub mod run;
pub mod schedule;
pub mod sizes;
pub mod strangers;
pub mod trace;

pub use error::{Error, Place};
