//! Weald from Python: the native half of the package `weald`, whose other half is in `python/weald`.
//!
//! This half holds landscapes, recipes and sessions, lends their layers to `NumPy` without a copy, and runs what takes time
//! in threads of its own while Python goes on. The other half has the names that people use.

mod arrays;
mod calls;
mod catalogue;
mod domain;
mod engines;
mod errors;
mod export;
mod landscape;
mod plants;
mod recipe;
mod session;
mod stored;
mod values;
mod watch;

use pyo3::prelude::*;

/// The native half of the package `weald`.
#[pymodule]
mod _weald {
    #[pymodule_export]
    use super::catalogue::catalogue;
    #[pymodule_export]
    use super::landscape::Landscape;
    #[pymodule_export]
    use super::recipe::{Recipe, fractal_recipe};
    #[pymodule_export]
    use super::session::Session;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "the name of such a constant in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
