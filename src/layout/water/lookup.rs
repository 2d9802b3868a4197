//! What baked water tables answer, from their files alone.

use super::{EvenCosine, WaterAxes};
use crate::error::{Error, Result};
use crate::files::Atlas;
use crate::files::manifest::{Manifest, Table};
use crate::geometry::Point;
use crate::layout::sky::volume::Texels;
use crate::layout::sky::{Component, multiply};
use crate::mapping::{Texel, texel};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

/// Name of the layout.
pub const LAYOUT: &str = "water";

/// One water of a bake, ready to answer.
pub struct WaterSky {
    pub wavelengths_nm: Vec<f64>,
    pub largest_depth: f64,
    axes: WaterAxes,
    /// Lower end of the sun axis of the light on the surface.
    lowest_sun: f64,
    slice: usize,
    bed: Vec<f64>,
    /// Rate of the rise with depth that the tables leave out, 1/m.
    kappa: Vec<f64>,
    rgb_from_four: Vec<Vec<f64>>,
    illuminance: f64,
    water: Grid,
    sky: Grid,
    seabed: Grid,
    seabed_sun: Grid,
    seabed_depth: Grid,
    light: Grid,
    fresnel: Grid,
    underwater: Option<[Grid; 3]>,
}

/// A table and its sizes along up to four axes.
struct Grid {
    texels: Texels,
    size: [usize; 4],
}

impl Grid {
    fn at(&self, place: [Texel; 4]) -> [f64; 4] {
        let [x, y, z, _] = self.size;
        self.texels.decode(self.texels.interpolate(&place, &[1, x, x * y, x * y * z]))
    }

    /// A row taken as it is.
    fn row(&self, x: Texel, row: usize, slice: usize) -> [f64; 4] {
        self.at([x, whole(row, self.size[1]), whole(slice, self.size[2]), (0, 0.0)])
    }
}

/// Texel number `k` itself.
fn whole(k: usize, size: usize) -> Texel {
    (k.min(size.max(1) - 1), 0.0)
}

/// A view of a water from above or, with an observer's depth, from within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaterView {
    /// Depth of the water, m.
    pub depth: f64,
    /// From above: cosine of the angle between the ray and the vertical, in the air, 0..1. From within: cosine of
    /// the zenith angle of the direction looked into, in the water.
    pub mu: f64,
    pub mu_s: f64,
}

impl WaterView {
    /// The view where it meets the water, down the ray from an observer above a planet of this radius (m), angles
    /// there; and the azimuth between view and sun there, rad.
    ///
    /// # Errors
    /// `Argument` where the ray never meets it.
    pub fn meet(ground: f64, depth: f64, p: &Point) -> Result<(WaterView, f64)> {
        let r = ground + p.altitude;
        let across2 = r * r * (1.0 - p.mu * p.mu);
        if p.mu >= 0.0 || across2 > ground * ground {
            let reason = format!("mu_view {} at {} m never meets the water: look down", p.mu, p.altitude);
            return Err(Error::Argument(format!("--water {reason}")));
        }
        if p.altitude == 0.0 {
            return Ok((WaterView { depth, mu: -p.mu, mu_s: p.mu_s }, p.azimuth_deg.to_radians()));
        }
        let cosine = (1.0 - across2 / (ground * ground)).max(0.0).sqrt();
        let length = p.altitude * (r + ground) / (-r * p.mu + ground * cosine);
        let mu_s = ((r * p.mu_s + length * p.nu()) / ground).clamp(-1.0, 1.0);
        let sines = ((1.0 - cosine * cosine) * (1.0 - mu_s * mu_s)).sqrt();
        // The angle between view and sun is the same everywhere on the ray.
        let azimuth = if sines > 0.0 { (p.nu() + cosine * mu_s) / sines } else { 1.0 };
        Ok((WaterView { depth, mu: cosine, mu_s }, libm::acos(azimuth.clamp(-1.0, 1.0))))
    }
}

impl WaterSky {
    /// Opens a water of a bake on disk.
    ///
    /// # Errors
    /// `Argument` where the bake has no such water, `File` for files that are missing or damaged.
    pub fn open(bake: &Path, manifest: &Manifest, name: &str) -> Result<WaterSky> {
        let folder = if bake.is_dir() { bake } else { bake.parent().unwrap_or(Path::new(".")) };
        let mut pictures = BTreeMap::new();
        for table in manifest.tables.iter().filter(|t| t.layout == LAYOUT) {
            pictures.insert(table.name.clone(), crate::layout::sky::picture(folder, table)?);
        }
        WaterSky::new(bake, manifest, name, &pictures)
    }

    /// The same from pictures in memory, by table name. `bake` is for messages.
    pub fn new(
        bake: &Path,
        manifest: &Manifest,
        name: &str,
        pictures: &BTreeMap<String, Atlas>,
    ) -> Result<WaterSky> {
        let known: Vec<&str> = manifest.waters.iter().map(|w| w.name.as_str()).collect();
        let Some(slice) = known.iter().position(|w| *w == name) else {
            let all = if known.is_empty() { "none".to_string() } else { known.join(", ") };
            return Err(Error::Argument(format!("no water {name} in this bake; there is {all}")));
        };
        WaterSky::read(manifest, name, slice, pictures)
            .map_err(|reason| Error::file(bake, format!("bake.json: {reason}")))
    }

    fn read(
        manifest: &Manifest,
        name: &str,
        slice: usize,
        pictures: &BTreeMap<String, Atlas>,
    ) -> Result<WaterSky> {
        let table = |name: &str| -> Result<(&Table, Grid)> {
            let found = manifest.tables.iter().find(|t| t.layout == LAYOUT && t.name == name);
            match (found, pictures.get(name)) {
                (Some(table), Some(atlas)) => Ok((table, grid(table, atlas)?)),
                _ => Err(format!("layout {LAYOUT} has no table {name}").into()),
            }
        };
        let list = |key: &str| -> Result<Vec<f64>> {
            let found = manifest.constants.get(key).filter(|v| v.iter().all(|x| x.is_finite()));
            found.cloned().ok_or(format!("constants.{key} is missing or not finite").into())
        };
        let number = |key: &str| -> Result<f64> {
            let v = list(key)?.first().copied().unwrap_or(0.0);
            if v > 0.0 { Ok(v) } else { Err(format!("constants.{key}: must be greater than 0").into()) }
        };
        let of = |what: &str| format!("water_{name}_{what}");
        let nm = list("four_wavelengths_nm")?;
        let bed = list(&of("seabed_albedo_at_four"))?;
        if !(1..=4).contains(&nm.len())
            || bed.len() != nm.len()
            || bed.iter().any(|a| !(0.0..=1.0).contains(a))
        {
            return Err(format!(
                "constants.{}: must be an albedo for each of the four wavelengths",
                of("seabed_albedo_at_four")
            )
            .into());
        }
        let kappa = list(&of("kappa_per_m"))?;
        if kappa.len() != nm.len() || kappa.iter().any(|k| *k < 0.0) {
            return Err(format!(
                "constants.{}: must be 0 or more, for each of the four wavelengths",
                of("kappa_per_m")
            )
            .into());
        }
        let matrix = of("rgb_from_four");
        let rgb = manifest
            .colour
            .matrices
            .get(&matrix)
            .filter(|m| m.len() == 3 && m.iter().all(|r| r.len() == nm.len()));
        let (water_table, water) = table(name)?;
        let (light_table, light) = table("irradiance")?;
        let axes = WaterAxes {
            largest_depth: constant(water_table, 0, "D_max", (1e-6, 1e6))?,
            depth_power: constant(water_table, 0, "p", (0.1, 10.0))?,
            n: constant(water_table, 1, "n", (1.0, 3.0))?,
        };
        let deep = format!("{name}_underwater");
        let underwater = match manifest.tables.iter().any(|t| t.layout == LAYOUT && t.name == deep) {
            false => None,
            true => {
                Some([table(&deep)?.1, table(&format!("{deep}_sky"))?.1, table(&format!("{deep}_seabed"))?.1])
            }
        };
        Ok(WaterSky {
            wavelengths_nm: nm,
            largest_depth: axes.largest_depth,
            axes,
            lowest_sun: constant(light_table, 0, "mu_min", (-1.0, 0.999))?,
            slice,
            bed,
            kappa,
            rgb_from_four: rgb
                .cloned()
                .ok_or(format!("colour.matrices.{matrix} is missing or has a wrong size"))?,
            illuminance: number("star_illuminance_lx")?,
            water,
            sky: table(&format!("{name}_sky"))?.1,
            seabed: table(&format!("{name}_seabed"))?.1,
            seabed_sun: table(&format!("{name}_seabed_sun"))?.1,
            seabed_depth: table(&format!("{name}_seabed_depth"))?.1,
            light,
            fresnel: table("fresnel")?.1,
            underwater,
        })
    }

    pub fn has_underwater(&self) -> bool {
        self.underwater.is_some()
    }

    /// Irradiance that the sun brings into the water and those of the surface by both parts of the sky, over the
    /// star's.
    fn lit(&self, mu_s: f64) -> [[f64; 4]; 3] {
        let sun = EvenCosine { name: "sun", least: self.lowest_sun };
        let Some(x) = sun.texel(mu_s, self.light.size[0]) else { return [[0.0; 4]; 3] };
        let [direct, high, low] = [0, 1, 2].map(|row| self.light.row(x, row, 0));
        let passed = self.passes(mu_s.max(0.0));
        [std::array::from_fn(|w| direct[w] * passed[w]), high, low]
    }

    /// 1 − F of a cosine in the air.
    fn passes(&self, mu: f64) -> [f64; 4] {
        self.fresnel.row(texel(mu, self.fresnel.size[0]), 3, self.slice)
    }

    /// Radiance of the bed with all its bounces.
    fn bed(&self, depth: Texel, sun: Texel, [entered, high, low]: &[[f64; 4]; 3]) -> [f64; 4] {
        let none = (0, 0.0);
        let by_sun = self.seabed_sun.at([depth, sun, none, none]);
        let [by_high, by_low, back] = [0, 1, 2].map(|row| self.seabed_depth.row(depth, row, 0));
        std::array::from_fn(|w| {
            let albedo = self.bed.get(w).copied().unwrap_or(0.0);
            let lit = entered[w] * by_sun[w] + high[w] * by_high[w] + low[w] * by_low[w];
            albedo * lit / (PI - albedo * back[w])
        })
    }

    /// The light that leaves the water along a view from above, over the star's irradiance, 1/sr, a wavelength
    /// each: that of the water (`scattering`), of the bed (`ground`), or both. What the surface mirrors is no
    /// part of it.
    pub fn leaving(&self, view: &WaterView, component: Component) -> Vec<f64> {
        let lit = self.lit(view.mu_s);
        let none = (0, 0.0);
        let sun = texel(view.mu_s.max(0.0), self.water.size[2]);
        let place = |grid: &Grid| {
            let depth = self.axes.depth_texel(view.depth, grid.size[0]);
            (depth, self.axes.view_texel(view.mu, grid.size[1]))
        };
        let mut sum = [0.0; 4];
        if component != Component::Ground {
            let (d, v) = place(&self.water);
            let water = self.water.at([d, v, sun, none]);
            let (d, v) = place(&self.sky);
            let [high, low] = [0, 1].map(|part| self.sky.at([d, v, whole(part, self.sky.size[2]), none]));
            let risen = |w: usize| match self.kappa.get(w) {
                Some(&kappa) if kappa > 0.0 => -libm::expm1(-kappa * view.depth),
                _ => 1.0,
            };
            sum = std::array::from_fn(|w| {
                risen(w) * (lit[0][w] * water[w] + lit[1][w] * high[w] + lit[2][w] * low[w])
            });
        }
        if component != Component::Scattering {
            let (d, v) = place(&self.seabed);
            let seen = self.seabed.at([d, v, none, none]);
            let sun = texel(view.mu_s.max(0.0), self.seabed_sun.size[1]);
            let bed = self.bed(d, sun, &lit);
            sum = std::array::from_fn(|w| sum[w] + bed[w] * seen[w]);
        }
        let passes = self.passes(view.mu);
        (0..self.wavelengths_nm.len()).map(|w| sum[w] * passes[w]).collect()
    }

    /// The light seen under water by an observer at a depth, the sun's disc left out; none without the tables.
    pub fn within(&self, view: &WaterView, observer: f64, component: Component) -> Option<Vec<f64>> {
        let [own, sky, seabed] = self.underwater.as_ref()?;
        let lit = self.lit(view.mu_s);
        let none = (0, 0.0);
        let share = if view.depth > 0.0 { (observer / view.depth).clamp(0.0, 1.0) } else { 0.0 };
        let cosine = EvenCosine { name: "view", least: -1.0 };
        let place = |grid: &Grid| {
            let depth = self.axes.depth_texel(view.depth, grid.size[0]);
            (depth, cosine.texel(view.mu, grid.size[1]).unwrap_or(none))
        };
        let mut sum = [0.0; 4];
        if component != Component::Ground {
            let (d, v) = place(own);
            let sun = texel(view.mu_s.max(0.0), own.size[2]);
            let water = own.at([d, v, sun, texel(share, own.size[3])]);
            let part = |k| sky.at([d, v, whole(k, sky.size[2]), texel(share, sky.size[3])]);
            let [high, low] = [0, 1].map(part);
            sum = std::array::from_fn(|w| lit[0][w] * water[w] + lit[1][w] * high[w] + lit[2][w] * low[w]);
        }
        if component != Component::Scattering {
            let (d, v) = place(seabed);
            let seen = seabed.at([d, v, texel(share, seabed.size[2]), none]);
            let sun = texel(view.mu_s.max(0.0), self.seabed_sun.size[1]);
            let deep = self.axes.depth_texel(view.depth, self.seabed_sun.size[0]);
            let bed = self.bed(deep, sun, &lit);
            sum = std::array::from_fn(|w| sum[w] + bed[w] * seen[w]);
        }
        Some(sum[..self.wavelengths_nm.len()].to_vec())
    }

    /// What the surface mirrors of unpolarised light at a cosine in the air, a wavelength each.
    pub fn mirrored(&self, mu: f64) -> Vec<f64> {
        let row = self.fresnel.row(texel(mu, self.fresnel.size[0]), 0, self.slice);
        row[..self.wavelengths_nm.len()].to_vec()
    }

    /// Linear RGB over the star's illuminance of light at the four wavelengths.
    pub fn rgb(&self, light: &[f64]) -> [f64; 3] {
        multiply(&self.rgb_from_four, light).map(|v| v / self.illuminance)
    }
}

/// A constant of an axis, inside its bounds.
fn constant(table: &Table, axis: usize, name: &str, (low, high): (f64, f64)) -> Result<f64> {
    let found = table.axes.get(axis).and_then(|a| a.constants.get(name)).copied();
    let found = found.ok_or(format!("tables.{}: axis {axis} has no {name}", table.name))?;
    if (low..=high).contains(&found) {
        Ok(found)
    } else {
        Err(format!("tables.{}.axes.{name} = {found}: must be between {low} and {high}", table.name).into())
    }
}

/// The table, its shape held against the file before it is used.
fn grid(table: &Table, atlas: &Atlas) -> Result<Grid> {
    let texels = table.shape.iter().try_fold(1usize, |n, &side| n.checked_mul(side));
    let held = atlas.slice_len().checked_mul(atlas.slices);
    if texels.is_none() || texels != held || table.shape.contains(&0) || table.shape.len() > 4 {
        return Err(
            format!("tables.{}.shape = {:?} is not that of {}", table.name, table.shape, table.file).into()
        );
    }
    let mut size = [1; 4];
    size[..table.shape.len()].copy_from_slice(&table.shape);
    Ok(Grid { texels: Texels::new(table, atlas)?, size })
}
