//! What an earlier generation left in a folder.

use super::counted;
use activecell_codegen::SourceFile;
use activecell_formats::files;
use std::fs;
use std::path::{Component, Path};

/// Where a generation notes its files.
pub(super) const LIST: &str = ".activecell-generated";

/// By this the list is known as ours.
const HEAD: &str = "# Written by activecell generate. The next one removes those of these files that it does not write, \
                    unless they were edited.\n";

/// The longest list or file of a generation, in bytes.
const MAX_BYTES: u64 = 1 << 26;

/// The list of what is generated: a checksum and a path a line.
pub(super) fn list(files: &[SourceFile]) -> String {
    let line = |file: &SourceFile| format!("{} {}\n", checksum(file.text.as_bytes()), file.path);
    HEAD.to_owned() + &files.iter().map(line).collect::<String>()
}

/// Fowler, Noll, Vo: the FNV-1a hash, 64 bits.
fn checksum(bytes: &[u8]) -> String {
    let hash = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", bytes.iter().fold(0xcbf2_9ce4_8422_2325, hash))
}

/// The files of an earlier generation in a folder.
pub(super) struct Earlier<'a> {
    folder: &'a Path,
    list: String,
}

impl<'a> Earlier<'a> {
    /// Those that the folder's list names; none if it has no list.
    pub(super) fn read(folder: &'a Path) -> Self {
        let bytes = files::read_bytes(&folder.join(LIST), MAX_BYTES).unwrap_or_default();
        Self { folder, list: String::from_utf8(bytes).unwrap_or_default() }
    }

    /// Removes those that are not among the new ones and still are what was written then; tells what it did.
    pub(super) fn remove_all_but(&self, new: &[SourceFile]) -> Vec<String> {
        let lines = self.list.strip_prefix(HEAD).unwrap_or_default().lines();
        let old = lines.filter_map(|line| line.split_once(' '));
        let old = old.filter(|(_, path)| new.iter().all(|file| file.path != *path) && is_inside(path));
        let (mut removed, mut left) = (0, Vec::new());
        for (sum, path) in old {
            let file = self.folder.join(path);
            let is_ours = files::read_bytes(&file, MAX_BYTES).is_ok_and(|bytes| checksum(&bytes) == sum);
            if is_ours && fs::remove_file(&file).is_ok() {
                removed += 1;
                remove_empty_folders(self.folder, path);
            } else if file.exists() {
                left.push(path);
            }
        }
        let removed =
            (removed > 0).then(|| format!("removed of an earlier generation: {}", counted(removed, "file")));
        let left = (!left.is_empty())
            .then(|| format!("of an earlier generation, but edited, so left: {}", left.join(", ")));
        removed.into_iter().chain(left).collect()
    }
}

/// Whether a path leads to something below where it begins.
fn is_inside(path: &str) -> bool {
    Path::new(path).components().all(|component| matches!(component, Component::Normal(_)))
}

/// The folders of a path that have nothing in them any more.
fn remove_empty_folders(folder: &Path, path: &str) {
    let parents = Path::new(path).ancestors().skip(1).filter(|parent| !parent.as_os_str().is_empty());
    for parent in parents {
        // Not if something is in it.
        let _ = fs::remove_dir(folder.join(parent));
    }
}
