//! Faults that show only when all keys of a table are known.

/// What is wrong with a key beside the others, or beside the materials of the recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The key, with the tables around it and the places in lists, counted from 1: `region`, `slippage.strength`,
    /// `where.2.below`.
    pub key: String,
    /// A sentence for the user.
    pub message: String,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl Fault {
    /// A fault of a key.
    pub fn of(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { key: key.into(), message: message.into() }
    }

    /// The fault of a key in the table `outer`.
    #[must_use]
    pub fn within(self, outer: &str) -> Self {
        Self { key: format!("{outer}.{}", self.key), ..self }
    }
}
