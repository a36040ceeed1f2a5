//! The free cells of a floor, numbered without gaps.

use crate::floor::{Floor, NONE};
use crate::passage::Layout;

/// The places of a floor: its free cells from 0 on, each with the places that it touches.
#[derive(Debug)]
pub(super) struct Ground {
    /// The number on the floor of each place.
    numbers: Vec<u32>,
    /// The place of each number on the floor.
    places: Vec<u32>,
    /// The bit of each place in a plane.
    bits: Vec<u32>,
    /// The place of each bit.
    by_bit: Vec<u32>,
    /// Where the links of each place begin.
    first: Vec<u32>,
    links: Vec<u32>,
}

impl Ground {
    pub(super) fn new(floor: &Floor) -> Self {
        let layout = Layout::new(floor);
        let mut places = vec![NONE; floor.numbers()];
        let mut numbers: Vec<u32> = floor.map().free().map(|cell| floor.number(cell)).collect();
        numbers.sort_unstable();
        for (place, &number) in numbers.iter().enumerate() {
            places[number as usize] = place as u32;
        }
        let bits: Vec<u32> = numbers.iter().map(|&number| layout.bit(floor.cell(number))).collect();
        let mut by_bit = vec![NONE; layout.words() * 64];
        for (place, &bit) in bits.iter().enumerate() {
            by_bit[bit as usize] = place as u32;
        }
        let (mut first, mut links) = (Vec::with_capacity(numbers.len() + 1), Vec::new());
        for &number in &numbers {
            first.push(links.len() as u32);
            links.extend(floor.links(number).iter().map(|&next| places[next as usize]));
        }
        first.push(links.len() as u32);
        Self { numbers, places, bits, by_bit, first, links }
    }

    /// How many places there are.
    pub(super) const fn len(&self) -> usize {
        self.numbers.len()
    }

    #[inline]
    pub(super) fn number(&self, place: u32) -> u32 {
        self.numbers[place as usize]
    }

    #[inline]
    pub(super) fn place(&self, number: u32) -> u32 {
        self.places[number as usize]
    }

    #[inline]
    pub(super) fn bit(&self, place: u32) -> u32 {
        self.bits[place as usize]
    }

    #[inline]
    pub(super) fn place_of_bit(&self, bit: u32) -> u32 {
        self.by_bit[bit as usize]
    }

    /// The places that one touches.
    #[inline]
    pub(super) fn links(&self, place: u32) -> &[u32] {
        let place = place as usize;
        &self.links[self.first[place] as usize..self.first[place + 1] as usize]
    }

    pub(super) fn bytes(&self) -> usize {
        let words = self.numbers.capacity()
            + self.places.capacity()
            + self.bits.capacity()
            + self.by_bit.capacity()
            + self.first.capacity()
            + self.links.capacity();
        words * size_of::<u32>()
    }
}
