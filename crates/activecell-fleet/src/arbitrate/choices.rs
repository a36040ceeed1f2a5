//! In which order a robot tries the cells around it.

use activecell::Rng;

/// The slot of a robot's own cell; slots below are the links of the cell.
pub(super) const STAY: u32 = 6;
/// Slots: six neighbours at most, and the own cell.
const SLOTS: u32 = 7;
/// Orders to draw from.
const ORDERS: usize = 32;

/// Slots to try, the first in the lowest four bits as its number plus one; 0 is the end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Choices(u32);

impl Choices {
    /// The slot to try first.
    pub(super) const fn first(&self) -> Option<u32> {
        (self.0 & 15).checked_sub(1)
    }

    /// The same slots, the last first.
    pub(super) const fn reversed(&self) -> Self {
        let (mut rest, mut back) = (self.0, 0);
        while rest != 0 {
            back = back << 4 | rest & 15;
            rest >>= 4;
        }
        Self(back)
    }

    /// This slot first; it is not taken from its place behind.
    pub(super) const fn after(&self, slot: u32) -> Self {
        Self(self.0 << 4 | (slot + 1))
    }
}

impl Iterator for Choices {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        let slot = self.first()?;
        self.0 >>= 4;
        Some(slot)
    }
}

/// Any set of slots in each of some random orders, ready to be looked up. With every order there is its
/// reverse, so that of two slots each comes first equally often.
#[derive(Debug, Clone)]
pub(super) struct Orders(Vec<[u32; 1 << SLOTS]>);

impl Orders {
    pub(super) fn new() -> Self {
        // The orders are the same in every run; which is taken when is the caller's chance.
        let mut rng = Rng::new(7);
        let mut tables = Vec::with_capacity(ORDERS);
        for _ in 0..ORDERS / 2 {
            let mut slots: Vec<u32> = (0..SLOTS).collect();
            rng.shuffle(&mut slots);
            tables.push(table(&slots));
            slots.reverse();
            tables.push(table(&slots));
        }
        Self(tables)
    }

    /// The slots of each class in an order that `chance` picks, one class after the other. A class is a set of bits.
    #[inline]
    pub(super) fn choose(&self, chance: u64, classes: impl IntoIterator<Item = u32>) -> Choices {
        let table = &self.0[chance as usize % ORDERS];
        let (mut packed, mut shift) = (0, 0);
        for class in classes.into_iter().filter(|&class| class != 0) {
            packed |= table[class as usize % table.len()] << shift;
            shift += 4 * class.count_ones();
        }
        Choices(packed)
    }
}

/// The slots of every set, packed in this order.
fn table(slots: &[u32]) -> [u32; 1 << SLOTS] {
    std::array::from_fn(|set| {
        let chosen = slots.iter().rev().filter(|&&slot| set >> slot & 1 == 1);
        chosen.fold(0, |packed, &slot| packed << 4 | (slot + 1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_come_one_after_the_other_and_each_slot_once() {
        let orders = Orders::new();
        for chance in 0..ORDERS as u64 {
            let choices = orders.choose(chance, [0b100_0010, 0, 0b1001, 0b11_0100]);
            let slots: Vec<u32> = choices.clone().collect();
            let mut parts = [slots[..2].to_vec(), slots[2..4].to_vec(), slots[4..].to_vec()];
            for part in &mut parts {
                part.sort_unstable();
            }
            assert_eq!(parts, [vec![1, 6], vec![0, 3], vec![2, 4, 5]]);
            let back: Vec<u32> = choices.reversed().collect();
            assert!(back.iter().rev().eq(&slots));
        }
        assert_eq!(Choices(0).after(STAY).collect::<Vec<_>>(), [STAY]);
    }

    #[test]
    fn of_two_slots_each_comes_first_equally_often() {
        let orders = Orders::new();
        for (a, b) in (0..SLOTS).flat_map(|b| (0..b).map(move |a| (a, b))) {
            let first = (0..ORDERS as u64)
                .filter(|&chance| orders.choose(chance, [1 << a | 1 << b]).first() == Some(a))
                .count();
            assert_eq!(first, ORDERS / 2);
        }
    }
}
