//! The solver against Monte Carlo, another maker's radiances, closed forms, conservation laws and the literal
//! Algorithm 1, and what must hold of it whatever the planet.

mod common;
#[path = "common/constituents.rs"]
mod constituents;

mod solver {
    mod bits;
    mod closed_forms;
    mod edges;
    mod energy;
    mod literal;
    mod monte_carlo;
    mod oracles;
    mod stability;
    mod tables;
    mod worlds;
}
