//! A file's bytes, as many as a reader asks for at most.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::Fault;
use weald_core::error::{Limit, Quantity};

/// All bytes of a file, where they are at most `limit`. The length is counted while reading, because a
/// device or a pipe has none to ask for.
pub fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let reading = File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes));
    reading.map_err(|cause| Fault::damaged(format!("cannot be read: {cause}")))?;
    if bytes.len() as u64 > limit {
        return Err(Limit::new(Quantity::FileBytes, None, 0..=limit).into());
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit_and_no_further() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("ten.tif");
        std::fs::write(&path, [7; 10]).expect("written");
        assert_eq!(read_at_most(&path, 10).expect("within"), [7; 10]);
        let error = read_at_most(&path, 9).expect_err("over").of(&path);
        assert_eq!(error.exit_code(), 5, "{error}");
        let missing = folder.path().join("none.tif");
        let error = read_at_most(&missing, 9).expect_err("missing").of(&missing);
        assert_eq!(error.exit_code(), 4, "{error}");
    }
}
