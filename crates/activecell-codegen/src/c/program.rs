//! The program M in C: its segments, its ends, and where the robot faces at first.

use super::firmware::{define, motion_name};
use super::units::Units;
use crate::model::player::Segment;
use crate::template::fill;
use activecell::{Cell, Dir, Error, Robot, Route};

/// The program M of a route.
#[derive(Debug, Clone, Copy)]
pub struct Program<'a> {
    /// The way that it drives, a shortest one: the examples look whether theirs are as long.
    pub route: &'a Route,
    /// The runs and turns along it; none if the robot is there already.
    pub segments: &'a [Segment],
    /// The robot that drives it; also the cells and turns of other ways are in its ticks.
    pub robot: &'a Robot,
}

impl Program<'_> {
    fn ends(&self) -> [Cell; 2] {
        let cells = self.route.cells();
        [cells.first(), cells.last()].map(|cell| cell.copied().unwrap_or(Cell::new(0, 0)))
    }

    /// Where the robot faces at first: along its first run.
    fn heading(&self) -> Option<Dir> {
        self.route.dirs().next()
    }

    /// What the player would never end.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.segments.iter().any(|segment| segment.ticks == 0) {
            return Err(Error::BadValue {
                name: "ticks of a segment of the program",
                value: 0.0,
                allowed: "at least 1; leave segments without ticks out",
            });
        }
        Ok(())
    }

    /// Bytes in read-only memory.
    pub(crate) const fn bytes(&self) -> u64 {
        8 * self.segments.len() as u64
    }

    /// The sentence that whoever sets the robot down must know.
    fn start(&self) -> String {
        let [from, _] = self.ends();
        let lattice = self.route.lattice();
        self.heading().map_or_else(
            || format!("At the start the robot stands at {from}, which is its target."),
            |dir| format!("At the start the robot stands at {from} and faces {}.", lattice.dir_name(dir)),
        )
    }

    /// What the header says of it.
    pub(super) fn declaration(&self) -> String {
        let [from, to] = self.ends();
        let heading =
            self.heading().map_or("ARRIVED".to_owned(), |dir| self.route.lattice().dir_name(dir).to_owned());
        let numbers = [
            define("AC_PROGRAM_FROM_X", from.x as u64, ""),
            define("AC_PROGRAM_FROM_Y", from.y as u64, ""),
            define("AC_PROGRAM_TO_X", to.x as u64, ""),
            define("AC_PROGRAM_TO_Y", to.y as u64, ""),
            format!("#define AC_PROGRAM_HEADING AC_{heading} /**< Where the robot faces at the start. */\n"),
            define(
                "AC_PROGRAM_STEPS",
                self.route.steps() as u64,
                "Steps of its way: as many as of every shortest one.",
            ),
            define("AC_PROGRAM_COUNT", self.segments.len() as u64, "Segments of the program."),
        ];
        let (length, about) = if self.segments.is_empty() {
            ("1", " It is empty: C has no array without an entry, so there is one that does not count.")
        } else {
            ("AC_PROGRAM_COUNT", "")
        };
        format!(
            "/*\n * The program M from {from} to {to}.\n * {}\n */\n{}\n/** The program M.{about} */\n\
             extern const ac_segment ac_program[{length}];\n",
            self.start(),
            numbers.concat(),
        )
    }

    /// The file with the segments.
    pub(super) fn listing(&self, units: &Units) -> String {
        let line =
            |Segment { motion, ticks }: &Segment| format!("    {{ {}, {ticks}U }},\n", motion_name(*motion));
        let segments: String = self.segments.iter().map(line).collect();
        let [from, to] = self.ends();
        let (length, segments) = if self.segments.is_empty() {
            ("1", "    { AC_RUN_FORWARD, 1U }, /* does not count: the program is empty */\n".to_owned())
        } else {
            ("AC_PROGRAM_COUNT", segments)
        };
        fill::<&str>(
            include_str!("templates/ac_program.c"),
            &[
                ("COUNT", &self.segments.len().to_string()),
                ("FROM", &from.to_string()),
                ("TO", &to.to_string()),
                ("START", &self.start()),
                ("ROBOT", &units.about()),
                ("LENGTH", length),
                ("SEGMENTS", &segments),
            ],
        )
    }
}
