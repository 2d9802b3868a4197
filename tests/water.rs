//! Water: the slab solver against closed forms, published numbers and Monte Carlo, presets, bakes.

#[path = "water/bakes.rs"]
mod bakes;
#[path = "water/closed_forms.rs"]
mod closed_forms;
#[path = "water/media.rs"]
mod media;
#[path = "water/monte_carlo.rs"]
mod monte_carlo;
#[path = "water/ocean.rs"]
mod ocean;
#[path = "water/orders.rs"]
mod orders;
#[path = "water/presets.rs"]
mod presets;
#[path = "water/skylight.rs"]
mod skylight;
