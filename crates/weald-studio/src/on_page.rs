//! What a studio on a page has to remember.

use std::rc::Rc;

use crate::host::Host;

/// What a studio on a page has beside all others.
pub(crate) struct OnPage {
    /// The page around it, where there is one.
    pub(crate) host: Option<Rc<dyn Host>>,
    /// Whether a link was asked for.
    pub(crate) shares: bool,
    /// Whether the first landscape runs as soon as it is there.
    pub(crate) plays_first: bool,
    /// Whether there is only the landscape.
    pub(crate) is_bare: bool,
}

impl OnPage {
    /// Who `plays` begins with a landscape alone.
    pub(crate) fn new(host: Option<Rc<dyn Host>>, plays: bool) -> Self {
        Self { host, shares: false, plays_first: plays, is_bare: plays }
    }
}
