//! Waters for tests, and their light from the solver.

use tyndall::internals::medium::{PhaseFunction, WaterMedium, WaterScatterer};
use tyndall::internals::transport::slab::{
    Dome, Layer, Pair, Slab, Streams, Surface, phase_mean, seabed_radiance,
};

/// One wavelength, one scatterer.
pub fn water(absorption: f64, scattering: f64, phase: PhaseFunction, n: f64, bed: f64) -> WaterMedium {
    WaterMedium {
        wavelengths_nm: vec![500.0],
        refractive_index: vec![n],
        absorption: vec![absorption],
        scatterers: vec![WaterScatterer {
            name: "all".into(),
            scattering: vec![scattering],
            phase: vec![phase],
        }],
        seabed_albedo: vec![bed],
    }
}

pub fn slab(medium: &WaterMedium) -> Slab {
    slab_of(medium, Streams::TABLES)
}

pub fn slab_of(medium: &WaterMedium, streams: Streams) -> Slab {
    Slab::new(medium, 0, Surface { n: medium.refractive_index[0] }, streams)
}

/// Azimuth means of the phase function from a beam of cosine `sun`, up and down along `view`.
pub fn means(medium: &WaterMedium, view: f64, sun: f64) -> Pair {
    [view, -view].map(|a| phase_mean(|nu| medium.phase(0, nu), a, -sun))
}

/// Radiance upwards just below the surface under a beam of unit irradiance, cosines in the water: of the water
/// over a black bed, and of the bed.
pub fn below(medium: &WaterMedium, depth: f64, view: f64, sun: f64) -> [f64; 2] {
    let slab = slab(medium);
    let layer = Layer::new(&slab, depth);
    let (beam, view) = (slab.beam(sun), slab.view(view));
    let pair = slab.pair(&beam, &view, means(medium, view.mu, beam.mu));
    let (sunlit, bed) = (layer.sun(&beam), layer.bed());
    let radiance =
        seabed_radiance(medium.seabed_albedo[0], layer.bed_irradiance(&sunlit), layer.bed_irradiance(&bed));
    [layer.up(&sunlit, &view, pair, 0.0), radiance * layer.up(&bed, &view, [0.0; 2], 0.0)]
}

/// Radiance that leaves the water, cosines in the air: of the water over a black bed, and of the bed.
pub fn leaving(medium: &WaterMedium, depth: f64, view: f64, sun: f64) -> [f64; 2] {
    let s = Surface { n: medium.refractive_index[0] };
    let light = below(medium, depth, s.cosine_in_water(view), s.cosine_in_water(sun));
    light.map(|l| l * s.sun_in_water(sun) * s.leaves(view))
}

/// The same under an even sky of unit irradiance.
pub fn leaving_of_sky(medium: &WaterMedium, depth: f64, view: f64) -> [f64; 2] {
    let slab = slab(medium);
    let layer = Layer::new(&slab, depth);
    let inside = slab.view(slab.surface.cosine_in_water(view));
    let (sky, bed) = (layer.sky(Dome::Even), layer.bed());
    let radiance =
        seabed_radiance(medium.seabed_albedo[0], layer.bed_irradiance(&sky), layer.bed_irradiance(&bed));
    let up = |field, scale: f64| scale * layer.up(field, &inside, [0.0; 2], 0.0) * slab.surface.leaves(view);
    [up(&sky, 1.0), up(&bed, radiance)]
}
