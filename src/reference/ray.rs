//! A straight ray cut into cells where shells begin and end, with the optical depth before and in each.

use super::shells::Shells;

/// A stretch of a ray inside one shell. Paths are signed, from the point nearest the planet's centre.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub shell: usize,
    pub from: f64,
    pub to: f64,
    /// Optical depth from the ray's start to the cell's.
    pub before: f64,
    /// Optical depth of the cell.
    pub depth: f64,
}

#[derive(Default)]
pub(super) struct Ray {
    pub cells: Vec<Cell>,
    /// Squared distance of the ray's line from the centre, m².
    pub b2: f64,
    /// Signed path at the ray's start and at its end, m.
    pub start: f64,
    pub end: f64,
    /// Optical depth of the whole ray.
    pub depth: f64,
    pub hits_ground: bool,
}

impl Ray {
    /// Fills this ray from a point inside the atmosphere (squared radius, its shell, signed path).
    pub(super) fn trace(&mut self, shells: &Shells, radius2: f64, shell: usize, start: f64) {
        self.cells.clear();
        self.b2 = (radius2 - start * start).max(0.0);
        self.start = start;
        self.depth = 0.0;
        self.hits_ground = start < 0.0 && self.b2 < shells.ground2();
        let (mut k, mut at) = (shell, start);
        if start < 0.0 {
            while shells.edges2[k] > self.b2 {
                let low = -(shells.edges2[k] - self.b2).sqrt();
                self.add(shells, k, &mut at, low);
                if k == 0 {
                    break;
                }
                k -= 1;
            }
            if !self.hits_ground {
                self.add(shells, k, &mut at, 0.0);
            }
        }
        if !self.hits_ground {
            for k in k..shells.count() {
                let to = (shells.edges2[k + 1] - self.b2).max(0.0).sqrt();
                self.add(shells, k, &mut at, to);
            }
        }
        self.end = at;
    }

    fn add(&mut self, shells: &Shells, shell: usize, at: &mut f64, to: f64) {
        if to > *at {
            let depth = self.cell_depth(shells, shell, *at, to);
            self.cells.push(Cell { shell, from: *at, to, before: self.depth, depth });
            self.depth += depth;
            *at = to;
        }
    }

    /// Optical depth between two signed paths inside a shell, on one side of the nearest point.
    #[inline(always)]
    pub(super) fn cell_depth(&self, shells: &Shells, shell: usize, from: f64, to: f64) -> f64 {
        let (a, b) = if from < 0.0 { (-to, -from) } else { (from, to) };
        shells.depth(shell, self.b2, a.max(0.0), b).max(0.0)
    }

    /// Cuts cells so that none is longer than `length` or deeper than `depth`.
    pub(super) fn subdivide(&mut self, shells: &Shells, length: f64, depth: f64) {
        const MOST: f64 = 256.0;
        let cells = std::mem::take(&mut self.cells);
        self.depth = 0.0;
        for c in cells {
            let parts = ((c.to - c.from) / length).max(c.depth / depth).ceil().clamp(1.0, MOST) as usize;
            let mut at = c.from;
            for k in 1..=parts {
                let to = c.from + (c.to - c.from) * (k as f64 / parts as f64);
                self.add(shells, c.shell, &mut at, to);
            }
        }
    }
}

impl Cell {
    /// Estimates of e^−τ across the cell, and of its mean there were τ to grow evenly: (1 + x + x²/2)^−4 with
    /// x = τ/4, within 0.1 % up to τ = 1 and too large beyond, which suits weights of sampling.
    #[inline(always)]
    pub(super) fn rough_transmittance(&self) -> (f64, f64) {
        let x = 0.25 * self.depth;
        let root = 1.0 + x * (1.0 + 0.5 * x);
        let square = root * root;
        let through = 1.0 / (square * square);
        let mean = if self.depth > 1e-3 { (1.0 - through) / self.depth } else { 1.0 - 0.5 * self.depth };
        (through, mean)
    }

    /// A path in the cell and its density, 1/m: e^−τ with τ growing evenly, or even where that is flat.
    pub(super) fn sample(&self, u: f64) -> (f64, f64) {
        let length = self.to - self.from;
        if self.depth <= 1e-4 {
            return (self.from + u * length, 1.0 / length);
        }
        let opaque = -libm::expm1(-self.depth);
        let passed = -libm::log1p(-u * opaque);
        let x = self.from + length * (passed / self.depth).min(1.0);
        (x, self.depth * (1.0 - u * opaque) / (opaque * length))
    }
}
