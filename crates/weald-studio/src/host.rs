//! What a page does for a studio in it, which has no file system of its own.

use std::path::PathBuf;

/// The page around a studio.
pub trait Host {
    /// Files that were dropped on the page or chosen since it was last asked, as they were put among the studio's files; or
    /// a sentence for the user.
    fn arrived(&self) -> Vec<Result<PathBuf, String>>;

    /// Lets the user choose a file, which will arrive.
    fn choose(&self);

    /// Gives the user a file to keep.
    fn hand_out(&self, name: &str, bytes: &[u8]);

    /// Makes a link of a recipe and a script of what was done by hand, and gives it to the user.
    fn share(&self, recipe: &str, script: &str);
}
