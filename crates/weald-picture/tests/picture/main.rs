//! Pictures by their pixels.

mod pictures;
mod view;
