//! Look-ups in the tables of three-atmosphere, as that package's shaders do them with all files loaded.

use super::Bruneton;
use crate::error::Result;
use crate::files::Atlas;
use crate::files::manifest::Manifest;
use crate::geometry::Point;
use crate::layout::sky::volume::{Place, Texels, enter, sun_at_ground};
use crate::layout::sky::{AerosolPhase, Channels, Component, Sky, Source};
use crate::mapping::texel;
use crate::medium::PhaseFunction;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_PI;
use std::path::Path;

/// The layout in memory.
pub struct ThreeAtmosphere {
    mapping: Bruneton,
    scattering: Texels,
    single_mie: Texels,
    transmittance: Flat,
    irradiance: Flat,
    g: f64,
    ground_albedo: Vec<f64>,
    illuminance: f64,
    /// Of the star, RGB.
    star: Vec<f64>,
    /// Aerosols' scattering over that of gas as RGB, where light scattered once by aerosols is guessed from its red.
    guess: Option<[f64; 3]>,
}

/// A table over two axes.
struct Flat {
    texels: Texels,
    size: [usize; 2],
}

impl Flat {
    fn at(&self, x: f64, y: f64) -> [f64; 3] {
        let place = [texel(x, self.size[0]), texel(y, self.size[1])];
        let [r, g, b, _] = self.texels.decode(self.texels.interpolate(&place, &[1, self.size[0]]));
        [r, g, b]
    }
}

impl ThreeAtmosphere {
    pub(in crate::internals::layout) fn new(source: &Source) -> Result<Self> {
        let texels = |name: &str| {
            let (table, atlas) = source.table(name)?;
            Texels::new(table, atlas).map_err(|reason| source.refuse(reason))
        };
        let flat = |name: &str| {
            let (table, _) = source.table(name)?;
            match table.shape[..] {
                [x, y] if x > 1 && y > 1 => Ok(Flat { texels: texels(name)?, size: [x, y] }),
                _ => Err(source.refuse(format!("{}: not two axes", table.file))),
            }
        };
        let radius = |name: &str| source.number(name);
        let (shape, size) = (&source.table("scattering")?.0.shape, Bruneton::SIZE);
        let mapping = Bruneton::new(radius("ground_radius_m")?, radius("top_radius_m")?, size)
            .filter(|_| {
                *shape == [size[2], size[3], size[1], size[0]]
                    && source.table("single_mie_scattering").is_ok_and(|t| t.0.shape == *shape)
            })
            .ok_or_else(|| {
                source.refuse(format!("bake.json: tables.scattering.shape = {shape:?} is not the package's"))
            })?;
        let colour = |name: &str| {
            let list = source.constant(name)?;
            if list.len() == 3 {
                Ok(list)
            } else {
                Err(source.refuse(format!("bake.json: constants.{name}: not three numbers")))
            }
        };
        Ok(ThreeAtmosphere {
            mapping,
            scattering: texels("scattering")?,
            single_mie: texels("single_mie_scattering")?,
            transmittance: flat("transmittance")?,
            irradiance: flat("irradiance")?,
            g: source.number("three_atmosphere_mie_g")?,
            ground_albedo: colour("three_atmosphere_ground_albedo_rgb")?,
            star: colour("three_atmosphere_star_rgb_lx")?,
            illuminance: source.number("star_illuminance_lx")?,
            guess: None,
        })
    }

    /// Tables of which, of light scattered once by aerosols, only the red in channel A of `scattering` is read, as by the
    /// package without `single_mie_scattering`, from pictures in memory: green and blue follow the rest of the light, times
    /// the quotients of `mie_over_rayleigh` (Bruneton 2017, GetExtrapolatedSingleMieScattering).
    ///
    /// # Errors
    /// As [`crate::layout::sky::of_pictures`].
    pub fn with_red_alone(
        bake: &Path,
        manifest: &Manifest,
        pictures: &BTreeMap<String, Atlas>,
        mie_over_rayleigh: [f64; 3],
    ) -> Result<Self> {
        let found = ThreeAtmosphere::new(&Source::new(bake, manifest, super::LAYOUT, pictures)?)?;
        Ok(ThreeAtmosphere { guess: Some(mie_over_rayleigh), ..found })
    }

    /// Linear RGB over the star's illuminance, 1/sr.
    fn colour(&self, point: &Point, component: Component) -> [f64; 3] {
        let Some(place) = enter(point, self.mapping.shell()) else { return [0.0; 3] };
        let mut out = [0.0; 3];
        if component != Component::Ground {
            out = self.sky(&place);
        }
        if component != Component::Scattering && place.hits_ground {
            let ground = self.ground(&place);
            (0..3).for_each(|c| out[c] += ground[c]);
        }
        out.map(|v| v / self.illuminance)
    }

    fn sky(&self, p: &Place) -> [f64; 3] {
        let [altitude, view, sun, nu] = self.mapping.locate(p.altitude, p.mu, p.mu_s, p.nu, p.hits_ground);
        let [_, views, suns, angles] = self.mapping.size();
        let place = [sun, nu, view, altitude];
        let strides = [1, suns, suns * angles, suns * angles * views];
        let at = |texels: &Texels| texels.decode(texels.interpolate(&place, &strides));
        let all = at(&self.scattering);
        let mie = match self.guess {
            None => at(&self.single_mie),
            Some(_) if all[0] <= 0.0 => [0.0; 4],
            Some(ratio) => {
                let red = all[3] / all[0];
                [
                    all[0] * red,
                    all[1] * red * (ratio[1] / ratio[0]),
                    all[2] * red * (ratio[2] / ratio[0]),
                    0.0,
                ]
            }
        };
        let gas = PhaseFunction::Rayleigh { king_factor: 1.0 }.value(p.nu);
        let aerosol = PhaseFunction::CornetteShanks { g: self.g }.value(p.nu);
        std::array::from_fn(|c| all[c] * gas + mie[c] * aerosol)
    }

    /// Transmittance to the top from a place whose ray leaves through it.
    fn to_top(&self, altitude: f64, mu: f64) -> [f64; 3] {
        let shell = self.mapping.shell();
        self.transmittance.at(shell.view_coordinate(altitude, mu, false), shell.altitude_coordinate(altitude))
    }

    /// Light of the ground that arrives, lx: the way to it is that from it to the top, over what is left of that
    /// behind the observer.
    fn ground(&self, p: &Place) -> [f64; 3] {
        let shell = self.mapping.shell();
        let [ground, _] = shell.radii();
        let length = shell.distance(p.altitude, p.mu, true);
        let mu_up = -((ground + p.altitude) * p.mu + length) / ground;
        let (whole, rest) = (self.to_top(0.0, mu_up.clamp(0.0, 1.0)), self.to_top(p.altitude, -p.mu));
        let mu_s = sun_at_ground(p, shell);
        let direct = if mu_s > 0.0 { self.to_top(0.0, mu_s).map(|t| t * mu_s) } else { [0.0; 3] };
        let diffuse = self.irradiance.at(0.5 * (1.0 + mu_s), 0.0);
        std::array::from_fn(|c| {
            let through = (whole[c] / rest[c]).min(1.0);
            through * self.ground_albedo[c] * FRAC_1_PI * (direct[c] * self.star[c] + diffuse[c])
        })
    }
}

impl Sky for ThreeAtmosphere {
    fn channels(&self) -> Channels {
        Channels::Rgb
    }

    fn outside(&self, _: &Point) -> Option<(&'static str, f64, String)> {
        None
    }

    fn radiance(&self, point: &Point, component: Component, _: AerosolPhase) -> Vec<f64> {
        self.colour(point, component).to_vec()
    }

    fn sunlight(&self, altitude: f64, mu_s: f64) -> [f64; 3] {
        if self.mapping.shell().hits_ground(altitude, mu_s) {
            return [0.0; 3];
        }
        let through = self.to_top(altitude, mu_s);
        std::array::from_fn(|c| through[c] * self.star[c] / self.illuminance)
    }

    fn rgb(&self, point: &Point, component: Component) -> [f64; 3] {
        self.colour(point, component)
    }
}
