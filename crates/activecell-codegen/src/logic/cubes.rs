//! Truth tables reduced to sums of products.

/// A product of literals: the variables that must be 1 and those that must be 0, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Cube {
    /// Variables that must be 1.
    pub ones: u32,
    /// Variables that must be 0.
    pub zeros: u32,
}

impl Cube {
    /// Whether the product is 1 for these values of the variables.
    pub const fn holds(self, values: u32) -> bool {
        values & self.ones == self.ones && values & self.zeros == 0
    }
}

/// An irredundant sum of products for a function of `variables` variables (at most 16): 1 where `on` says so, 0 where
/// neither `on` nor `any` does; where `any` says so it does not matter. Both are asked once for each assignment, variable
/// `i` in bit `i`.
///
/// After S. Minato, *Fast Generation of Irredundant Sum-of-Products Forms from Binary Decision Diagrams*, SASIMI 1992,
/// which goes back to E. Morreale, *Recursive Operators for Prime Implicant and Irredundant Normal Form Determination*,
/// IEEE Transactions on Computers C-19, 1970; here on plain truth tables.
///
/// ```
/// use activecell_codegen::logic::{Cube, sum_of_products};
/// // Rule 136 over X4 X1 X2 (bits 2, 1, 0): closed where X1 and X2 are.
/// let cubes = sum_of_products(3, |bits| 136 >> bits & 1 == 1, |_| false);
/// assert_eq!(cubes, [Cube { ones: 0b011, zeros: 0 }]);
/// ```
pub fn sum_of_products(variables: u32, on: impl Fn(u32) -> bool, any: impl Fn(u32) -> bool) -> Vec<Cube> {
    let assignments = 0..1u32 << variables;
    let lower: Vec<bool> = assignments.clone().map(|values| on(values) && !any(values)).collect();
    let upper: Vec<bool> = assignments.map(|values| on(values) || any(values)).collect();
    cover(&lower, &upper).cubes
}

/// Some cubes and the function that they make together.
struct Cover {
    cubes: Vec<Cube>,
    function: Vec<bool>,
}

/// Covers `lower` and nothing outside `upper`. Both are truth tables; their top variable halves them.
fn cover(lower: &[bool], upper: &[bool]) -> Cover {
    if !lower.contains(&true) {
        return Cover { cubes: Vec::new(), function: vec![false; lower.len()] };
    }
    if !upper.contains(&false) {
        return Cover { cubes: vec![Cube::default()], function: vec![true; lower.len()] };
    }
    let half = lower.len() / 2;
    // The top variable, as a bit.
    let bit = half as u32;
    let ([lower0, lower1], [upper0, upper1]) = (halves(lower), halves(upper));
    // What only one half may cover needs the variable; the rest is covered without it.
    let only0 = cover(&and_not(lower0, upper1), upper0);
    let only1 = cover(&and_not(lower1, upper0), upper1);
    let rest0 = and_not(lower0, &only0.function);
    let rest1 = and_not(lower1, &only1.function);
    let rest: Vec<bool> = zip(&rest0, &rest1, |a, b| a || b);
    let both = cover(&rest, &zip(upper0, upper1, |a, b| a && b));
    let zero = only0.cubes.into_iter().map(|cube| Cube { zeros: cube.zeros | bit, ..cube });
    let one = only1.cubes.into_iter().map(|cube| Cube { ones: cube.ones | bit, ..cube });
    let function0 = zip(&only0.function, &both.function, |a, b| a || b);
    let function1 = zip(&only1.function, &both.function, |a, b| a || b);
    Cover {
        cubes: zero.chain(one).chain(both.cubes.iter().copied()).collect(),
        function: [function0, function1].concat(),
    }
}

fn halves(table: &[bool]) -> [&[bool]; 2] {
    let (low, high) = table.split_at(table.len() / 2);
    [low, high]
}

fn and_not(a: &[bool], b: &[bool]) -> Vec<bool> {
    zip(a, b, |a, b| a && !b)
}

fn zip(a: &[bool], b: &[bool], f: impl Fn(bool, bool) -> bool) -> Vec<bool> {
    a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use activecell::Rng;

    #[test]
    fn sums_equal_their_tables_and_no_product_can_go() {
        let mut rng = Rng::new(1);
        for case in 0..400 {
            let variables = case % 8;
            let table: Vec<u32> = (0..1 << variables).map(|_| rng.below(3)).collect();
            let value = |values: u32| table[values as usize];
            let cubes = sum_of_products(variables, |v| value(v) == 1, |v| value(v) == 2);
            let covers = |cubes: &[Cube]| {
                (0..1u32 << variables)
                    .all(|v| value(v) == 2 || cubes.iter().any(|cube| cube.holds(v)) == (value(v) == 1))
            };
            assert!(covers(&cubes));
            for leave_out in 0..cubes.len() {
                let mut fewer = cubes.clone();
                fewer.remove(leave_out);
                assert!(!covers(&fewer), "{cubes:?} has one too many");
            }
        }
    }
}
