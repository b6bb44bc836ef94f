//! What recipes called otherwise in earlier versions. A line here is all that a new name needs: the old one is answered
//! with the new one, and `weald migrate` rewrites it.

/// A name that has changed.
#[derive(Clone, Copy, Debug)]
pub struct Renamed {
    /// Section of the recipe: `landscape`, `material`, `fractal`, `step` or `output`.
    pub section: &'static str,
    /// The tables of the section that have this word under this key, as `("do", "lakes")`; all where it is `None`.
    pub kind: Option<(&'static str, &'static str)>,
    /// What has another name.
    pub what: What,
}

/// What has another name.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// A key.
    Key {
        /// What it was called.
        old: &'static str,
        /// What it is called.
        new: &'static str,
    },
    /// A word that a key can have as its value.
    Word {
        /// The key.
        key: &'static str,
        /// What the word was.
        old: &'static str,
        /// What it is.
        new: &'static str,
    },
}

/// All changes of names.
pub const RENAMED: &[Renamed] = &[
    key("step", ("do", "constant"), "value", "height"),
    key("step", ("do", "lakes"), "film", "shallowest"),
    key("step", ("do", "moisture"), "film", "shallowest"),
    key("step", ("do", "wetness"), "least_slope", "min_slope"),
    key("step", ("do", "curvature"), "level_deg", "min_slope_deg"),
    key("output", ("export", "grass"), "most", "max_sets"),
];

const fn key(
    section: &'static str,
    kind: (&'static str, &'static str),
    old: &'static str,
    new: &'static str,
) -> Renamed {
    Renamed { section, kind: Some(kind), what: What::Key { old, new } }
}

impl Renamed {
    /// The key that it is about, by its old name.
    pub(super) fn key(&self) -> &'static str {
        match self.what {
            What::Key { old, .. } => old,
            What::Word { key, .. } => key,
        }
    }

    /// The change, as a sentence for the user.
    pub(super) fn sentence(&self) -> String {
        match self.what {
            What::Key { old, new } => format!("`{old}` is now called `{new}`"),
            What::Word { key, old, new } => format!("{key} = {old:?} is now called {new:?}"),
        }
    }
}
