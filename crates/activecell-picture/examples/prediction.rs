//! Draws `docs/pictures/prediction.svg`: a robot waits for an object that crosses its corridor.

#![expect(clippy::print_stdout, reason = "an example that prints its picture")]

use activecell::predict::{Bounds, Closures, Slots, Track};
use activecell::{Cell, Error, Lattice, Map};

fn main() -> Result<(), Error> {
    let map = Map::parse(Lattice::Square, "####.####\n####.####\n.........\n####.####\n####.####")?;
    let (robot, target) = (Cell::new(1, 2), Cell::new(8, 2));
    let bounds = Bounds { radius_m: 0.25, max_speed_mps: 1.2, max_accel_mps2: 0.06, seen_within_m: 0.005 };
    let mut object = Track::new(bounds)?;
    let [x, y] = map.centre_m(Cell::new(4, 0));
    for i in 0..9 {
        object.observe(0.25 * f64::from(i), [x, y + 0.25 * f64::from(8 - i)])?;
    }
    let slots = Slots { certain: 4, likely: 2, ..Slots::default() };
    let closures = Closures::new(&map, robot, slots, 2.0, &[object])?;
    let field = map.wave(target)?;
    let plan = closures.plan(robot, |cell| field.steps(cell));
    print!("{}", activecell_picture::prediction_svg(&map, &closures, &plan, 6));
    Ok(())
}
