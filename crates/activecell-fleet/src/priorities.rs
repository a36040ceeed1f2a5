//! Who goes first.

/// The robots in the order of their priorities: who has been away from its target longest, then who is farthest from it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Priorities {
    order: Vec<u32>,
    /// Where the next robot of each waiting time goes.
    places: Vec<u32>,
}

impl Priorities {
    /// Sorts by counting; the ranks decide between equals.
    pub(crate) fn fill(&mut self, waits: &[u16], ranks: &[u32]) {
        let longest = usize::from(waits.iter().copied().max().unwrap_or(0));
        self.places.clear();
        self.places.resize(longest + 2, 0);
        for &wait in waits {
            self.places[longest - usize::from(wait) + 1] += 1;
        }
        for i in 1..self.places.len() {
            self.places[i] += self.places[i - 1];
        }
        self.order.resize(waits.len(), 0);
        for &robot in ranks {
            let place = &mut self.places[longest - usize::from(waits[robot as usize])];
            self.order[*place as usize] = robot;
            *place += 1;
        }
    }

    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }
}
