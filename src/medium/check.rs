//! Whether a medium is one that can be solved: every number finite and in its range.

use super::{Constituent, DensityProfile, Medium, PhaseFunction};
use crate::error::Result;

/// Largest radius of a top, m: fourteen times the sun's.
pub(super) const MOST_RADIUS: f64 = 1e10;
/// Largest height of the air in radii of the ground.
pub(super) const MOST_HEIGHT: f64 = 10.0;
/// Largest vertical optical depth; a thousand times that of the thickest clouds.
pub(super) const MOST_DEPTH: f64 = 1e5;

/// Nodes of a density profile at most, far more than shipped planets have: the solver has a shell for each, and with five
/// thousand a bake of small tables took minutes.
pub const MOST_NODES: usize = 1000;

/// Radii of ground and top (m) that make a shell of air; the reason where they do not.
pub fn check_shell(ground: f64, top: f64) -> Result<()> {
    if !(ground > 0.0 && top > ground) {
        return Err(
            format!("the top ({top} m) must lie above the ground ({ground} m), and that above 0").into()
        );
    }
    if top > MOST_RADIUS {
        return Err(format!("the top lies at {top:e} m; {MOST_RADIUS:e} m is the most").into());
    }
    let height = (top - ground) / ground;
    if height > MOST_HEIGHT {
        return Err(format!("the air is {height:.4} ground radii high; {MOST_HEIGHT} are the most").into());
    }
    Ok(())
}

impl Medium {
    /// Whether the medium can be solved; else the first number that stands against it, and its place.
    pub fn check(&self) -> Result<()> {
        check_shell(self.ground_radius, self.top_radius)?;
        for (nm, albedo) in self.wavelengths_nm.iter().zip(&self.ground_albedo) {
            if !(0.0..=1.0).contains(albedo) {
                return Err(format!("ground albedo at {nm} nm = {albedo}: must be between 0 and 1").into());
            }
        }
        for c in &self.constituents {
            c.density.check().map_err(|reason| format!("profile of {}: {reason}", c.name))?;
            (0..self.wavelengths_nm.len()).try_for_each(|w| {
                c.check(w).map_err(|reason| format!("{} at {} nm: {reason}", c.name, self.wavelengths_nm[w]))
            })?;
        }
        for (nm, depth) in self.wavelengths_nm.iter().zip(self.vertical_optical_depth()) {
            if depth.is_nan() || depth > MOST_DEPTH {
                let most = format!("{MOST_DEPTH:e} is the most");
                return Err(format!("vertical optical depth at {nm} nm = {depth:e}: {most}").into());
            }
        }
        Ok(())
    }
}

impl Constituent {
    fn check(&self, w: usize) -> Result<()> {
        for (name, v) in [("scattering", self.scattering[w]), ("absorption", self.absorption[w])] {
            if !(v >= 0.0 && v.is_finite()) {
                return Err(format!("{name} coefficient = {v} 1/m: must be 0 or more, and finite").into());
            }
        }
        let g = self.similarity_g[w];
        if !(-1.0..=1.0).contains(&g) {
            return Err(format!("asymmetry = {g}: must be between -1 and 1").into());
        }
        self.phase[w].check()
    }
}

impl PhaseFunction {
    fn check(&self) -> Result<()> {
        let asymmetries = match self {
            PhaseFunction::HenyeyGreenstein { g } | PhaseFunction::CornetteShanks { g } => vec![*g],
            PhaseFunction::DoubleHenyeyGreenstein { g1, g2, .. } => vec![*g1, *g2],
            _ => Vec::new(),
        };
        if let Some(g) = asymmetries.iter().find(|g| g.is_nan() || g.abs() >= 1.0) {
            return Err(format!("asymmetry = {g}: must be greater than -1 and less than 1").into());
        }
        let nodes = match self {
            PhaseFunction::Tabulated { nodes } => nodes.iter().map(|n| n.0).collect(),
            _ => vec![-1.0, 0.0, 1.0],
        };
        match nodes.iter().map(|&nu| (nu, self.value(nu))).find(|(_, v)| !(*v >= 0.0 && v.is_finite())) {
            Some((nu, v)) => {
                Err(format!("phase function at the cosine {nu} = {v}: must be 0 or more, and finite").into())
            }
            None => Ok(()),
        }
    }
}

impl DensityProfile {
    /// Whether the profile's numbers are finite, in order and not negative.
    pub fn check(&self) -> Result<()> {
        let rising = |list: &[f64]| {
            let good = list.iter().all(|z| z.is_finite()) && list.windows(2).all(|z| z[0] < z[1]);
            if good { Ok(()) } else { Err("altitudes must rise, and be finite".into()) }
        };
        match self {
            DensityProfile::Exponential { scale_height }
                if *scale_height > 0.0 && scale_height.is_finite() =>
            {
                Ok(())
            }
            DensityProfile::Exponential { scale_height } => {
                Err(format!("scale height = {scale_height} m: must be greater than 0").into())
            }
            DensityProfile::Tent { bottom, centre, top } => rising(&[*bottom, *centre, *top]),
            DensityProfile::Layer { bottom, top } => rising(&[*bottom, *top]),
            DensityProfile::Linear { nodes } | DensityProfile::LogLinear { nodes } => {
                if nodes.len() > MOST_NODES {
                    return Err(format!("{} nodes: {MOST_NODES} are the most", nodes.len()).into());
                }
                let least =
                    if matches!(self, DensityProfile::Linear { .. }) { 0.0 } else { f64::MIN_POSITIVE };
                if let Some((z, d)) = nodes.iter().find(|n| !(n.1 >= least && n.1.is_finite())) {
                    return Err(format!("density at {z} m = {d}: out of range").into());
                }
                rising(&nodes.iter().map(|n| n.0).collect::<Vec<_>>())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A moon of methane haze passes; each number taken out of its range is named.
    #[test]
    fn what_cannot_be_solved_is_named() {
        let moon = |change: &dyn Fn(&mut Medium)| {
            let mut medium = Medium {
                ground_radius: 2.575e6,
                top_radius: 3.2e6,
                wavelengths_nm: vec![440.0, 550.0],
                ground_albedo: vec![0.1, 0.2],
                constituents: vec![Constituent {
                    name: "haze".into(),
                    role: crate::medium::Role::Aerosol,
                    density: DensityProfile::Exponential { scale_height: 5e4 },
                    scattering: vec![1e-5, 8e-6],
                    absorption: vec![1e-6, 1e-6],
                    phase: vec![PhaseFunction::HenyeyGreenstein { g: 0.6 }; 2],
                    similarity_g: vec![0.6; 2],
                }],
            };
            change(&mut medium);
            medium.check()
        };
        assert_eq!(moon(&|_| ()).unwrap(), ());
        type Change = fn(&mut Medium);
        let changes: [(Change, &str); 9] = [
            (|m| m.top_radius = 1e300, "the top lies at 1e300 m"),
            (|m| m.top_radius = f64::NAN, "must lie above the ground"),
            (|m| m.top_radius = 5e7, "ground radii high"),
            (|m| m.ground_albedo[1] = 1.5, "ground albedo at 550 nm = 1.5"),
            (
                |m| m.constituents[0].scattering[0] = f64::INFINITY,
                "haze at 440 nm: scattering coefficient = inf",
            ),
            (|m| m.constituents[0].absorption[1] = -1e-9, "haze at 550 nm: absorption coefficient"),
            (|m| m.constituents[0].scattering[1] = 1e3, "vertical optical depth at 550 nm"),
            (|m| m.constituents[0].phase[0] = PhaseFunction::HenyeyGreenstein { g: 1.0 }, "asymmetry = 1"),
            (
                |m| m.constituents[0].density = DensityProfile::Exponential { scale_height: 0.0 },
                "scale height = 0 m",
            ),
        ];
        for (change, reason) in changes {
            let refusal = moon(&change).unwrap_err().to_string();
            assert!(refusal.contains(reason), "{refusal}");
        }
    }
}
