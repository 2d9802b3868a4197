//! Tables as arrays, and the mappings between physical coordinates and texels. No physics here.

mod array;
mod elek2010;
mod layer;
mod sun_curve;
mod warp;
mod window;

pub use array::{Array, Element, Texel, texel};
pub use elek2010::{AxisFormula, Elek2010, HALVES, WINDOW};
pub use layer::Layer;
pub use sun_curve::SunCurve;
pub use warp::Warp;
pub use window::{Span, Views, Window};
