//! From the spectra of one planet's skies to colour: a sample of those skies, and weights fitted on them.

pub mod samples;
pub mod weights;
