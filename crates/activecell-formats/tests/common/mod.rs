//! What several tests need: hand-made PNG files, and files with something changed.
#![allow(dead_code)] // Each test uses its part.

use activecell_formats::raster::{Channels, Image, write_png};
use proptest::prelude::*;
use proptest::sample::Index;
use std::io::Write;

/// Where a file is changed, by which byte, and how.
pub(crate) type Change = (Index, u8, u8);

/// A few changes.
pub(crate) fn changes() -> impl Strategy<Value = Vec<Change>> {
    prop::collection::vec((any::<Index>(), any::<u8>(), 0..5_u8), 1..6)
}

/// A file with bytes put over others, put in and taken out, or its end cut off. Most files are text, so that some of the
/// bytes put in are digits and signs.
pub(crate) fn changed(mut bytes: Vec<u8>, changes: Vec<Change>) -> Vec<u8> {
    for (index, byte, kind) in changes {
        if bytes.is_empty() {
            break;
        }
        let at = index.index(bytes.len());
        match kind {
            0 => bytes[at] = byte,
            1 => bytes.insert(at, byte),
            2 => drop(bytes.remove(at)),
            3 => bytes.insert(at, b"0123456789(),;:->.\n"[usize::from(byte) % 19]),
            _ => bytes.truncate(at),
        }
    }
    bytes
}

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

/// A `NumPy` array: its type, shape and elements as they lie in memory.
pub(crate) fn npy(dtype: &str, shape: &str, fortran: bool, elements: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(elements);
    bytes
}

/// An archive of files.
pub(crate) fn npz(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in files {
        archive.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// The heights of [`tiff`]: one is missing.
pub(crate) const TIFF_HEIGHTS: [i16; 6] = [10, 20, 30, 40, -999, 60];

/// A small `GeoTIFF` of 3 × 2 posts, 2 m and 3 m apart, the upper left post's centre at (100, 200): floats in
/// DEFLATE, or plain whole numbers.
pub(crate) fn tiff(floats: bool) -> Vec<u8> {
    use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};
    use tiff::tags::Tag;
    let mut bytes = std::io::Cursor::new(Vec::new());
    let compression =
        if floats { Compression::Deflate(DeflateLevel::default()) } else { Compression::Uncompressed };
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap().with_compression(compression);
    macro_rules! write {
        ($kind:ty, $heights:expr) => {{
            let mut image = encoder.new_image::<$kind>(3, 2).unwrap();
            let tags = image.encoder();
            tags.write_tag(Tag::ModelPixelScaleTag, &[2.0, 3.0, 0.0][..]).unwrap();
            tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 100.0, 200.0, 0.0][..]).unwrap();
            let keys: [u16; 12] = [1, 1, 0, 2, 1024, 0, 1, 1, 1025, 0, 1, 2];
            tags.write_tag(Tag::GeoKeyDirectoryTag, &keys[..]).unwrap();
            tags.write_tag(Tag::GdalNodata, "-999").unwrap();
            image.write_data($heights).unwrap();
        }};
    }
    if floats {
        write!(colortype::Gray32Float, &TIFF_HEIGHTS.map(f32::from));
    } else {
        write!(colortype::GrayI16, &TIFF_HEIGHTS);
    }
    bytes.into_inner()
}
