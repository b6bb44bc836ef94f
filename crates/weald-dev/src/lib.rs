//! What developers of Weald run and users never build: renewing the committed pictures, and tests of the tree itself.
//! Its dependencies need compilers of C and C++.

mod coding;
mod film;
mod flip;
mod keep;
mod page;
mod renew;
mod step_pictures;

pub use coding::{Coded, code, decode};
pub use flip::{Flip, flip};
pub use keep::{Kept, VISIBLE, keep};
pub use page::{GREATEST_EFFORT, PageFile, page};
pub use renew::{Renewed, renew};
pub use step_pictures::step_pictures;
