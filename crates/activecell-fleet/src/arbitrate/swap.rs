//! Two robots that must change places in a corridor: who backs out, and whom it pulls after it.
//!
//! Source: K. Okumura, *Improving `LaCAM` for Scalable Eventually Optimal Multi-Agent Pathfinding*, IJCAI 2023; after
//! R. Luna and K. Bekris, *Push and Swap*, IJCAI 2011.

use super::Arbiter;
use crate::floor::NONE;
use std::cmp::Ordering;

/// How many cells along a corridor two robots look. Without it a queue of n robots in a corridor of n cells would take n²
/// time a step; robots that are farther from a fork come to it by the same rule.
const FORESEEN: usize = 100;

/// What a cell behind the front cell of a corridor offers.
enum Ahead {
    /// Two ways or more: robots can pass each other.
    Fork,
    /// One way on.
    Way(u32),
    DeadEnd,
}

impl Arbiter<'_> {
    /// The robot that `robot`, whose wish is the cell `wish`, should pull after itself while it backs out.
    pub(super) fn partner(&self, robot: u32, here: u32, wish: u32, next: &[u32]) -> Option<u32> {
        if wish == here || self.floor.is_roomy(wish) {
            return None;
        }
        let other = self.cells[wish as usize].now;
        if other != NONE
            && next[other as usize] == NONE
            && self.must_swap([robot, other], here, wish)
            && self.can_swap(wish, here)
        {
            return Some(other);
        }
        // One step ahead: a robot behind wants through where this one is going.
        let mut behind = self.floor.links(here).iter().filter(|&&cell| cell != wish);
        behind.find_map(|&cell| {
            let other = self.cells[cell as usize].now;
            let pull =
                other != NONE && self.must_swap([other, robot], here, wish) && self.can_swap(wish, here);
            pull.then_some(other)
        })
    }

    /// Whether the pusher, in cell `behind`, and the puller, in `front`, want through each other and meet no fork
    /// while the pusher drives the puller along its way.
    fn must_swap(&self, [pusher, puller]: [u32; 2], mut behind: u32, mut front: u32) -> bool {
        let push = self.fields.field(self.goals[pusher as usize].slot);
        for _ in 0..FORESEEN {
            if push.compare(behind, front) != Ordering::Less {
                break;
            }
            match self.ahead(behind, front) {
                Ahead::Fork => return false,
                Ahead::Way(on) => (behind, front) = (front, on),
                Ahead::DeadEnd => break,
            }
        }
        let pull = self.fields.field(self.goals[puller as usize].slot);
        pull.compare(front, behind) == Ordering::Less
            && (behind == self.goals[pusher as usize].target || push.compare(behind, front) == Ordering::Less)
    }

    /// Whether the robot in `front`, driven back by the one in `behind`, comes to a fork, where it can let it pass.
    fn can_swap(&self, mut behind: u32, mut front: u32) -> bool {
        let origin = behind;
        while front != origin {
            match self.ahead(behind, front) {
                Ahead::Fork => return true,
                Ahead::Way(on) => (behind, front) = (front, on),
                Ahead::DeadEnd => return false,
            }
        }
        false
    }

    /// The ways on from `front`, coming from `behind`. A dead end whose robot is at home in it is none.
    fn ahead(&self, behind: u32, front: u32) -> Ahead {
        let open = |&&cell: &&u32| {
            let at = self.cells[cell as usize].now;
            let home = at != NONE && self.goals[at as usize].target == cell;
            cell != behind && !(home && self.floor.links(cell).len() == 1)
        };
        let mut ways = self.floor.links(front).iter().filter(open);
        match (ways.next(), ways.next()) {
            (None, _) => Ahead::DeadEnd,
            (Some(&on), None) => Ahead::Way(on),
            _ => Ahead::Fork,
        }
    }
}
