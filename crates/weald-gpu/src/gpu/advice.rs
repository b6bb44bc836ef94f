//! What a user may do where a device fails: a simulation can run on the processor, a picture can be made smaller.

/// What helps against each fault of a device; each goes on from "…; ".
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Advice {
    /// It cannot be opened.
    pub(crate) unopened: &'static str,
    /// It does not answer.
    pub(crate) silent: &'static str,
    /// It was lost.
    pub(crate) lost: &'static str,
    /// Its memory is full.
    pub(crate) full: &'static str,
    /// The budget of memory is spent.
    pub(crate) spent: &'static str,
    /// A buffer is larger than it allows.
    pub(crate) large: &'static str,
}

/// To those who simulate.
pub(crate) const SIMULATION: Advice = Advice {
    unopened: "use --engine cpu",
    silent: "use --engine cpu",
    lost: "run again, or use --engine cpu",
    full: "give it a smaller --gpu-memory, end other programs that use it, or use --engine cpu",
    spent: "give a larger --gpu-memory, a smaller grid, or --engine cpu",
    large: "use a smaller grid or --engine cpu",
};

/// To those who draw.
pub(crate) const DRAWING: Advice = Advice {
    unopened: "draw on the processor by --fallback view",
    silent: "draw smaller pictures, or fewer sets of grass",
    lost: "run again",
    full: "draw a smaller picture or with 1 sample a pixel, or end other programs that use it",
    spent: "give a larger --gpu-memory, a smaller picture, or 1 sample a pixel",
    large: "draw a smaller picture, or a landscape of fewer cells",
};

/// To those who hold a landscape in a window.
pub(crate) const WINDOW: Advice = Advice {
    unopened: "open the window's device as `Gpu::device_descriptor` says",
    silent: "make the window smaller, or use a smaller grid",
    lost: "open the landscape again",
    full: "make the window smaller, use a smaller grid, or end other programs that use it",
    spent: "make the window smaller, or use a smaller grid",
    large: "use a smaller grid",
};

/// To those who simulate on a page.
pub(crate) const PAGE: Advice = Advice {
    unopened: "close other pages that use it",
    silent: "load the page again: what you did is kept",
    lost: "load the page again, or go on without a device by ?rays in its address: what you did is kept",
    full: "use a smaller grid, or close other pages",
    spent: "use a smaller grid",
    large: "use a smaller grid",
};
