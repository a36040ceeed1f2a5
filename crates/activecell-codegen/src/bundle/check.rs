//! What is checked before anything is written out.

use crate::logic::{Circuit, Fault};
use crate::{c, circuits};
use activecell::{Error, Lattice};
use std::fmt;

/// Why nothing was generated.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum GenerateError {
    /// The map, the task or the robot does not allow it.
    Order(Error),
    /// A circuit that not every language takes: a mistake of this crate.
    Circuit {
        /// The name of the circuit.
        circuit: String,
        /// What is wrong with it.
        fault: Fault,
    },
}

impl fmt::Display for GenerateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Order(error) => error.fmt(f),
            Self::Circuit { circuit, fault } => {
                write!(f, "circuit {circuit}, {fault}; this is a mistake in activecell: please report it")
            }
        }
    }
}

impl std::error::Error for GenerateError {}

impl From<Error> for GenerateError {
    fn from(error: Error) -> Self {
        Self::Order(error)
    }
}

/// Every circuit that the parts print for these lattices.
pub(super) fn all_circuits(lattices: &[Lattice]) -> Vec<Circuit> {
    let of_lattice = |&lattice: &Lattice| {
        [
            circuits::sector(lattice),
            circuits::decision(lattice),
            circuits::fabric_cell(lattice),
            c::lane_number(lattice),
        ]
    };
    lattices.iter().flat_map(of_lattice).chain([circuits::control(), circuits::player()]).collect()
}

/// Refuses circuits that cannot be written out in every language.
pub(super) fn check(circuits: &[Circuit]) -> Result<(), GenerateError> {
    circuits.iter().try_for_each(|circuit| {
        circuit.check().map_err(|fault| GenerateError::Circuit { circuit: circuit.name.clone(), fault })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::Expr;

    #[test]
    fn our_circuits_can_be_written_out() {
        assert_eq!(check(&all_circuits(&Lattice::ALL)), Ok(()));
    }

    #[test]
    fn a_faulty_circuit_is_named() {
        let mut circuit = Circuit::new("turn", "Whether to turn.");
        let left = circuit.input("left", 1, "what lies to the left");
        circuit.output("signal", Expr::Signal(left), "a keyword of VHDL");
        let error = check(&[circuits::control(), circuit]).unwrap_err().to_string();
        assert_eq!(
            error,
            "circuit turn, signal signal: the name is a keyword of a language, or that of the circuit; \
             this is a mistake in activecell: please report it"
        );
    }
}
