//! What several tests need: hand-made PNG files.
#![allow(dead_code)] // Each test uses its part.

use activecell_formats::raster::{Channels, Image, write_png};

/// The checksum of PNG chunks (ISO 3309), bit by bit.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(
            crc ^ u32::from(byte),
            |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 },
        )
    })
}

/// A PNG of `width` × `height` gray pixels, all 200.
pub(crate) fn gray_png(width: u32, height: u32) -> Vec<u8> {
    let samples = vec![200; width as usize * height as usize];
    write_png(&Image::new(width, height, Channels::Gray, samples).unwrap()).unwrap()
}

/// The same file with another header: size, bits a sample, colour type; the checksum is right.
pub(crate) fn with_header(png: &[u8], width: u32, height: u32, bits: u8, colour: u8) -> Vec<u8> {
    let mut png = png.to_vec();
    assert_eq!(&png[12..16], b"IHDR");
    png[16..20].copy_from_slice(&width.to_be_bytes());
    png[20..24].copy_from_slice(&height.to_be_bytes());
    (png[24], png[25]) = (bits, colour);
    let crc = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&crc.to_be_bytes());
    png
}
