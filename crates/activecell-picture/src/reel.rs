//! The GIF file as it is written: of each frame only what differs from the one before.

use crate::Error;
use crate::palette::SAME;
use std::borrow::Cow;
use std::ops::Range;

/// Frames of colour numbers on their way into a file.
pub(crate) struct Reel {
    encoder: gif::Encoder<Vec<u8>>,
    width: usize,
    /// The last frame.
    last: Vec<u8>,
    /// A frame waits here until it is known that the next one differs.
    waiting: gif::Frame<'static>,
}

impl Reel {
    /// A reel whose first frame covers all of its `size`; `palette` holds red, green and blue of each number.
    pub(crate) fn new(
        first: Vec<u8>,
        [width, height]: [u32; 2],
        delay_cs: u16,
        palette: &[u8],
    ) -> Result<Self, Error> {
        let size = |size: u32| u16::try_from(size).map_err(|_| Error::Canvas { width, height });
        let (w, h) = (size(width)?, size(height)?);
        let mut encoder = gif::Encoder::new(Vec::new(), w, h, palette).map_err(|error| encoding(&error))?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(|error| encoding(&error))?;
        let waiting = gif::Frame {
            delay: delay_cs,
            width: w,
            height: h,
            buffer: Cow::Owned(first.clone()),
            ..gif::Frame::default()
        };
        Ok(Self { encoder, width: width as usize, last: first, waiting })
    }

    /// Adds a frame: the smallest rectangle that holds all changes, the rest of it “as before”.
    pub(crate) fn shoot(&mut self, frame: &[u8], delay_cs: u16) -> Result<(), Error> {
        let Some((columns, rows)) = self.changed(frame) else {
            self.waiting.delay = self.waiting.delay.saturating_add(delay_cs);
            return Ok(());
        };
        let mut buffer = Vec::with_capacity(columns.len() * rows.len());
        for y in rows.clone() {
            let pixels = y * self.width + columns.start..y * self.width + columns.end;
            let pairs = frame[pixels.clone()].iter().zip(&self.last[pixels]);
            buffer.extend(pairs.map(|(&now, &before)| if now == before { SAME } else { now }));
        }
        self.last.copy_from_slice(frame);
        // The sizes fit: they are parts of the whole, which fitted.
        let next = gif::Frame {
            delay: delay_cs,
            left: columns.start as u16,
            top: rows.start as u16,
            width: columns.len() as u16,
            height: rows.len() as u16,
            transparent: Some(SAME),
            buffer: Cow::Owned(buffer),
            ..gif::Frame::default()
        };
        let before = std::mem::replace(&mut self.waiting, next);
        self.encoder.write_frame(&before).map_err(|error| encoding(&error))
    }

    /// How long the file is so far.
    pub(crate) fn bytes(&self) -> usize {
        self.encoder.get_ref().len()
    }

    pub(crate) fn finish(mut self) -> Result<Vec<u8>, Error> {
        self.encoder.write_frame(&self.waiting).map_err(|error| encoding(&error))?;
        self.encoder.into_inner().map_err(|error| Error::Encoding(error.to_string()))
    }

    /// Columns and rows of the rectangle in which a frame differs from the last.
    fn changed(&self, frame: &[u8]) -> Option<(Range<usize>, Range<usize>)> {
        let (mut left, mut right) = (usize::MAX, 0);
        let (mut top, mut bottom) = (None, 0);
        let rows = frame.chunks_exact(self.width).zip(self.last.chunks_exact(self.width));
        for (y, (now, before)) in rows.enumerate().filter(|(_, (now, before))| now != before) {
            let differs = |(a, b): (&u8, &u8)| a != b;
            let mut pairs = now.iter().zip(before);
            left = left.min(pairs.clone().position(differs).unwrap_or(0));
            right = right.max(pairs.rposition(differs).unwrap_or(0) + 1);
            top = top.or(Some(y));
            bottom = y + 1;
        }
        top.map(|top| (left..right, top..bottom))
    }
}

fn encoding(error: &gif::EncodingError) -> Error {
    Error::Encoding(error.to_string())
}
