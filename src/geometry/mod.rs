//! The geometry of a shell of air around a planet, and of views into it. No physics and no files.

mod angles;
mod directions;
mod point;
pub mod view;

pub use angles::{horizon_cosine, view_sun_cosine};
pub use directions::{Direction, directions};
pub use point::Point;
