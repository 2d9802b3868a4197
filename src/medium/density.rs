//! Relative density of a constituent against altitude.

/// A relative density profile. Altitudes in metres over the ground.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum DensityProfile {
    /// exp(−altitude / scale height) (Elek & Kmoch Eq. 3).
    Exponential { scale_height: f64 },
    /// Rises linearly from 0 at `bottom` to 1 at `centre` and falls to 0 at `top`.
    Tent { bottom: f64, centre: f64, top: f64 },
    /// Constant 1 between two altitudes, 0 elsewhere.
    Layer { bottom: f64, top: f64 },
    /// Linear between nodes (altitude, density) in rising order; 0 outside them.
    Linear { nodes: Vec<(f64, f64)> },
    /// Linear in the logarithm between nodes of positive density; 0 outside them.
    LogLinear { nodes: Vec<(f64, f64)> },
}

impl DensityProfile {
    /// Relative density at an altitude.
    pub fn at(&self, altitude: f64) -> f64 {
        match self {
            DensityProfile::Exponential { scale_height } => libm::exp(-altitude / scale_height),
            DensityProfile::Tent { bottom, centre, top } => {
                let rise = if altitude < *centre {
                    (altitude - bottom) / (centre - bottom)
                } else {
                    (top - altitude) / (top - centre)
                };
                rise.clamp(0.0, 1.0)
            }
            DensityProfile::Layer { bottom, top } => {
                f64::from(u8::from(altitude >= *bottom && altitude <= *top))
            }
            DensityProfile::Linear { nodes } => between(nodes, altitude, |a, b, t| a + (b - a) * t),
            DensityProfile::LogLinear { nodes } => {
                between(nodes, altitude, |a, b, t| a * libm::exp(t * libm::log(b / a)))
            }
        }
    }

    /// Altitudes where the profile or its slope jumps.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            DensityProfile::Exponential { .. } => Vec::new(),
            DensityProfile::Tent { bottom, centre, top } => vec![*bottom, *centre, *top],
            DensityProfile::Layer { bottom, top } => vec![*bottom, *top],
            DensityProfile::Linear { nodes } | DensityProfile::LogLinear { nodes } => {
                nodes.iter().map(|n| n.0).collect()
            }
        }
    }

    /// Altitude (m) above which there is nothing; infinite for an exponential.
    pub fn end(&self) -> f64 {
        match self {
            DensityProfile::Exponential { .. } => f64::INFINITY,
            _ => self.kinks().into_iter().fold(0.0, f64::max),
        }
    }

    /// Height (m) over which the density falls by e; infinite but for an exponential.
    pub fn scale(&self) -> f64 {
        match self {
            DensityProfile::Exponential { scale_height } => *scale_height,
            _ => f64::INFINITY,
        }
    }

    /// Vertical column ∫ density dz between two altitudes, m.
    pub fn column(&self, from: f64, to: f64) -> f64 {
        if let DensityProfile::Exponential { scale_height } = self {
            // Closed form: a thin layer under a high top would fall between the steps of a rule.
            return -scale_height * libm::exp(-from / scale_height) * libm::expm1((from - to) / scale_height);
        }
        let mut edges = vec![from, to];
        edges.extend(self.kinks().into_iter().filter(|&k| k > from && k < to));
        edges.sort_by(f64::total_cmp);
        edges.windows(2).map(|e| self.smooth_column(e[0], e[1])).sum()
    }

    fn smooth_column(&self, from: f64, to: f64) -> f64 {
        const HALVES: usize = 400;
        let step = (to - from) / (2 * HALVES) as f64;
        // Values at the very ends are taken just inside, where a layer has not jumped yet.
        let inside = |k: usize| from + step * (k as f64).clamp(1e-9, 2.0 * HALVES as f64 - 1e-9);
        let sum: f64 = (0..=2 * HALVES)
            .map(|k| {
                let weight = if k == 0 || k == 2 * HALVES { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
                weight * self.at(inside(k))
            })
            .sum();
        sum * step / 3.0
    }
}

fn between(nodes: &[(f64, f64)], altitude: f64, blend: impl Fn(f64, f64, f64) -> f64) -> f64 {
    let after = nodes.partition_point(|n| n.0 <= altitude);
    if after == 0 {
        return 0.0;
    }
    let (z0, d0) = nodes[after - 1];
    match nodes.get(after) {
        Some(&(z1, d1)) => blend(d0, d1, (altitude - z0) / (z1 - z0)),
        None => {
            if altitude == z0 {
                d0
            } else {
                0.0
            }
        }
    }
}
