//! Files that a page and its worker have alike, each in its own memory. On a machine there is one file system for both.

use super::message::ChangedFile;

/// What has changed here since it was last asked.
#[cfg(target_arch = "wasm32")]
pub(super) fn changes() -> Vec<ChangedFile> {
    weald::files::take_changes()
}

/// Does here what the other has done.
#[cfg(target_arch = "wasm32")]
pub(super) fn take_over(files: Vec<ChangedFile>) {
    weald::files::take_over(files);
}

/// What has changed here since it was last asked.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn changes() -> Vec<ChangedFile> {
    Vec::new()
}

/// Does here what the other has done.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn take_over(_: Vec<ChangedFile>) {}
