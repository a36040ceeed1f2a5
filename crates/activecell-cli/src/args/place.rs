//! Places and directions as a user names them.

use super::WrongArgument;
use activecell::{Cell, Dir, Lattice, Map, PointM};
use std::str::FromStr;

/// A place as a user names it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    Cell(Cell),
    Metres(PointM),
    Mark(char),
}

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let help = "give a cell as X,Y, a point as 1.5m,2m, or the letter of a named cell";
        let mut letters = text.chars();
        if let (Some(letter), None) = (letters.next(), letters.next())
            && letter.is_ascii_alphabetic()
        {
            return Ok(Self::Mark(letter));
        }
        let (x, y) = text.split_once(',').ok_or(help)?;
        let (x, y) = (x.trim(), y.trim());
        if let (Some(x), Some(y)) = (x.strip_suffix('m'), y.strip_suffix('m')) {
            let metres = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
            return Ok(Self::Metres([metres(x).ok_or(help)?, metres(y).ok_or(help)?]));
        }
        let cell = |text: &str| text.parse().map_err(|_| help.to_owned());
        Ok(Self::Cell(Cell::new(cell(x)?, cell(y)?)))
    }
}

impl Place {
    /// The cell of the map that is meant.
    pub(crate) fn on(self, map: &Map) -> anyhow::Result<Cell> {
        match self {
            Self::Cell(cell) => Ok(cell),
            Self::Metres(point) => {
                let cell = map.cell_at_m(inwards(map, point));
                anyhow::ensure!(
                    map.contains(cell),
                    "the point {} m, {} m is outside the map, which {}",
                    point[0],
                    point[1],
                    extent(map)
                );
                Ok(cell)
            }
            Self::Mark(letter) => map.mark(letter).ok_or_else(|| {
                let names: Vec<String> = map.marks().iter().map(|mark| mark.0.to_string()).collect();
                let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                anyhow::anyhow!("the map names no cell `{letter}`; it names: {known}")
            }),
        }
    }
}

/// A point on the map's very edge belongs to the cell inside.
fn inwards(map: &Map, point: PointM) -> PointM {
    let size_m = map.size_m();
    let edge_m = 1e-9 * map.frame().cell_m.max(1.0);
    let mut local = map.frame().to_mosaic(point);
    for axis in 0..2 {
        if (-edge_m..=size_m[axis] + edge_m).contains(&local[axis]) {
            local[axis] = local[axis].clamp(edge_m, size_m[axis] - edge_m);
        }
    }
    map.frame().to_floor(local)
}

/// From where to where a map reaches, in metres.
fn extent(map: &Map) -> String {
    let frame = map.frame();
    let [w, h] = map.size_m();
    let turned =
        if frame.yaw_rad == 0.0 { String::new() } else { format!(", turned by {} rad", frame.yaw_rad) };
    let [x, y] = frame.origin_m;
    format!("begins at {x} m, {y} m and is {w:.3} m wide and {h:.3} m high{turned}")
}

/// The direction of that name.
pub(crate) fn heading(lattice: Lattice, name: &str) -> anyhow::Result<Dir> {
    lattice.dir_named(name).ok_or_else(|| {
        let names: Vec<&str> = lattice.dirs().map(|dir| lattice.dir_name(dir)).collect();
        let names = names.join(", ");
        WrongArgument(format!("--heading {name}: no such direction on this lattice; use one of {names}"))
            .into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_cells_metres_or_marks() {
        assert_eq!("3,4".parse(), Ok(Place::Cell(Cell::new(3, 4))));
        assert_eq!("-3, 4".parse(), Ok(Place::Cell(Cell::new(-3, 4))));
        assert_eq!("1.5m,-2m".parse(), Ok(Place::Metres([1.5, -2.0])));
        assert_eq!("S".parse(), Ok(Place::Mark('S')));
        for bad in ["", "3", "3,", "3,4m", "nanm,1m", "1e999m,1m", "3.5,1", "99999999999,1", "Ä"] {
            assert!(bad.parse::<Place>().is_err(), "{bad}");
        }
    }
}
