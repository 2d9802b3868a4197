//! Axes of the water tables: depth, view through the surface, sun, and depth of an observer under water.

use crate::mapping::AxisFormula;
use crate::mapping::{Texel, texel};

/// The parameterisation of the paper's water table (Elek & Kmoch 2010, §4.1), with two changes: depth is finer
/// near 0 (the paper's linear axis has its first texel at 3.2 m), and the view is that of the refracted ray. All
/// axes have texel centres at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaterAxes {
    /// Depth of the last texel, m.
    pub largest_depth: f64,
    /// D = D_max x^power
    pub depth_power: f64,
    /// Refractive index that spreads the view axis.
    pub n: f64,
}

impl WaterAxes {
    /// Depth of texel `i` of `size`, m.
    pub fn depth(&self, i: usize, size: usize) -> f64 {
        self.largest_depth * libm::pow(i as f64 / (size - 1) as f64, self.depth_power)
    }

    /// Coordinate 0..1 of a depth in metres, clamped at both ends.
    pub fn depth_coordinate(&self, depth: f64) -> f64 {
        libm::pow((depth / self.largest_depth).clamp(0.0, 1.0), 1.0 / self.depth_power)
    }

    pub fn depth_texel(&self, depth: f64, size: usize) -> Texel {
        texel(self.depth_coordinate(depth), size)
    }

    fn critical(&self) -> f64 {
        (1.0 - 1.0 / (self.n * self.n)).sqrt()
    }

    /// Cosine in the air of view texel `j` of `size`: even steps of the cosine in the water, from the edge of
    /// Snell's window (0) to straight down (1).
    pub fn mu(&self, j: usize, size: usize) -> f64 {
        if j + 1 == size {
            return 1.0;
        }
        let critical = self.critical();
        let inside = critical + (1.0 - critical) * (j as f64 / (size - 1) as f64);
        (1.0 - self.n * self.n * (1.0 - inside * inside)).max(0.0).sqrt()
    }

    /// Coordinate 0..1 of a view of cosine `mu` in the air.
    pub fn view_coordinate(&self, mu: f64) -> f64 {
        let critical = self.critical();
        let inside = (1.0 - (1.0 - mu * mu) / (self.n * self.n)).sqrt();
        if critical < 1.0 { (inside - critical) / (1.0 - critical) } else { 0.0 }
    }

    pub fn view_texel(&self, mu: f64, size: usize) -> Texel {
        texel(self.view_coordinate(mu), size)
    }

    pub fn depth_axis(&self, size: usize) -> AxisFormula {
        AxisFormula {
            name: "depth",
            size,
            coordinate: "x = (D / D_max)^(1 / p)",
            inverse: "D = D_max x^p",
            constants: vec![("D_max", self.largest_depth), ("p", self.depth_power)],
        }
    }

    pub fn view_axis(&self, size: usize) -> AxisFormula {
        AxisFormula {
            name: "view",
            size,
            coordinate: "x = (m - c) / (1 - c), m = sqrt(1 - (1 - mu^2) / n^2), c = sqrt(1 - 1 / n^2); mu: cosine \
                         between the ray in the air and the vertical, 0..1",
            inverse: "m = c + (1 - c) x, mu = sqrt(1 - n^2 (1 - m^2))",
            constants: vec![("n", self.n)],
        }
    }
}

/// A cosine that runs evenly from `least` to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenCosine {
    pub name: &'static str,
    pub least: f64,
}

impl EvenCosine {
    pub fn at(&self, i: usize, size: usize) -> f64 {
        self.least + (1.0 - self.least) * (i as f64 / (size - 1) as f64)
    }

    /// None below the axis, where it is dark.
    pub fn texel(&self, mu: f64, size: usize) -> Option<Texel> {
        (mu >= self.least).then(|| texel((mu - self.least) / (1.0 - self.least), size))
    }

    pub fn axis(&self, size: usize) -> AxisFormula {
        AxisFormula {
            name: self.name,
            size,
            coordinate: "x = (mu - mu_min) / (1 - mu_min)",
            inverse: "mu = mu_min + (1 - mu_min) x",
            constants: vec![("mu_min", self.least)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every texel's coordinate is its place, on all axes, and the ends are surface, largest depth, the edge of
    /// Snell's window and straight down.
    #[test]
    fn axes_and_their_inverses() {
        let axes = WaterAxes { largest_depth: 40.0, depth_power: 3.0, n: 1.4 };
        for i in 0..7 {
            let x = i as f64 / 6.0;
            assert!((axes.depth_coordinate(axes.depth(i, 7)) - x).abs() < 1e-12);
            assert!((axes.view_coordinate(axes.mu(i, 7)) - x).abs() < 1e-12);
        }
        assert_eq!([axes.depth(0, 7), axes.depth(6, 7), axes.mu(6, 7)], [0.0, 40.0, 1.0]);
        assert!(axes.mu(0, 7) < 1e-7);
        let sun = EvenCosine { name: "sun", least: -0.2 };
        assert_eq!(sun.texel(-0.21, 5), None);
        assert_eq!(sun.texel(sun.at(3, 5), 5), Some((3, 0.0)));
    }
}
