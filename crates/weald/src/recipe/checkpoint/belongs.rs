//! What tells to which run a checkpoint belongs, and of which kind it is.

/// Name of the checkpoint in the output folder.
pub const CHECKPOINT_FILE: &str = "checkpoint.weald";

/// With what a checkpoint of a run in memory begins.
pub(super) const MAGIC: &[u8; 8] = b"WEALDCP1";

/// With what the manifest of one by parts begins.
pub(super) const MAGIC_OF_PARTS: &[u8; 8] = b"WEALDCM1";

/// Most bytes of a header: a recipe of the greatest length and ample room for reports.
pub(super) const MAX_HEADER: u64 = 64 << 20;

/// Whether a checkpoint of a version and a recipe belongs to this recipe and version; if not, what differs.
pub(super) fn fits(of_version: &str, of_recipe: &str, recipe: &str) -> Result<(), String> {
    let version = env!("CARGO_PKG_VERSION");
    if of_version != version {
        return Err(format!(
            "was written by Weald {of_version}; this is {version}, whose bits may differ; go on with that version, or run \
             without --resume"
        ));
    }
    if of_recipe == recipe {
        return Ok(());
    }
    let (mut old, mut new) = (of_recipe.lines(), recipe.lines());
    loop {
        let lines = (old.next(), new.next());
        if lines.0 != lines.1 {
            let [old, new] = [lines.0, lines.1].map(|line| line.unwrap_or("nothing"));
            return Err(format!(
                "belongs to another recipe: it has `{old}` where this run has `{new}`; give the same recipe and \
                 options, or run without --resume"
            ));
        }
    }
}
