//! Sun positions for which a ray is integrated at once, and the sun axis of the solver's state.

/// Pairs that are worked on at once.
pub(crate) const CHUNK: usize = 16;

/// Some neighbouring pairs; the last chunk is filled up with copies of its first pair.
#[derive(Clone, Debug)]
pub struct PairChunk {
    pub mu_s: [f32; CHUNK],
    pub across: [f32; CHUNK],
}

impl PairChunk {
    /// The sun's zenith cosines at a point, turned by an angle about the planet's centre.
    #[inline(always)]
    pub fn turned(&self, cos_turn: f32, sin_turn: f32) -> [f32; CHUNK] {
        let mut sun = [0.0; CHUNK];
        for k in 0..CHUNK {
            sun[k] = self.mu_s[k] * cos_turn + self.across[k] * sin_turn;
        }
        sun
    }
}

/// Where a chunk of sun positions lies on an axis: nodes, and the weights of each and of the next one.
#[derive(Clone, Copy)]
pub struct Places {
    pub nodes: [u32; CHUNK],
    pub low: [f32; CHUNK],
    pub high: [f32; CHUNK],
}

impl Places {
    pub const NONE: Places = Places { nodes: [0; CHUNK], low: [0.0; CHUNK], high: [0.0; CHUNK] };

    /// True where nothing counts.
    #[inline(always)]
    pub fn is_dark(&self) -> bool {
        let mut largest = 0.0;
        for k in 0..CHUNK {
            let sum = self.low[k] + self.high[k];
            largest = if sum > largest { sum } else { largest };
        }
        largest == 0.0
    }
}

/// Sun zenith cosines and relative azimuths; every combination is a pair.
#[derive(Clone, Debug)]
pub struct Pairs {
    pub sun_count: usize,
    pub azimuth_count: usize,
    /// Per pair, azimuth fastest: sun zenith cosine, and its sine times the cosine of the azimuth.
    pub mu_s: Vec<f32>,
    pub across: Vec<f32>,
    pub chunks: Vec<PairChunk>,
}

impl Pairs {
    pub fn new(mu_s: &[f64], cos_azimuth: &[f64]) -> Self {
        let all = mu_s.iter().flat_map(|&m| cos_azimuth.iter().map(move |&c| (m, c)));
        Pairs { sun_count: mu_s.len(), azimuth_count: cos_azimuth.len(), ..Self::listed(all) }
    }

    /// Any pairs of a sun zenith cosine and the cosine of an azimuth, each for itself.
    pub fn listed(pairs: impl Iterator<Item = (f64, f64)>) -> Self {
        let (mut cosines, mut across) = (Vec::new(), Vec::new());
        for (m, c) in pairs {
            cosines.push(m as f32);
            across.push(((1.0 - m * m).max(0.0).sqrt() * c) as f32);
        }
        let chunks = cosines.chunks(CHUNK).zip(across.chunks(CHUNK));
        let fill = |v: &[f32]| std::array::from_fn(|k| v[if k < v.len() { k } else { 0 }]);
        let chunks = chunks.map(|(m, a)| PairChunk { mu_s: fill(m), across: fill(a) }).collect();
        Pairs { sun_count: cosines.len(), azimuth_count: 1, mu_s: cosines, across, chunks }
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.mu_s.len()
    }

    pub fn is_empty(&self) -> bool {
        self.mu_s.is_empty()
    }
}

/// Azimuths (k + ½)π/n, at which a mean over n points integrates cosines up to order 2n − 1 exactly.
pub(crate) fn midpoint_azimuths(n: usize) -> Vec<f64> {
    (0..n).map(|k| libm::cos((k as f64 + 0.5) * std::f64::consts::PI / n as f64)).collect()
}

/// Nodes of the sun's zenith cosine, even in x = u / (|u| + 0.4) with u = mu_s + 0.07, which puts them closest
/// where the light fades fastest: with the sun some degrees below the horizon.
#[derive(Clone, Debug)]
pub struct SunAxis {
    pub mu_s: Vec<f64>,
    lowest: f32,
    lowest_x: f32,
    scale: f32,
}

const SHIFT: f64 = 0.07;
const WIDTH: f64 = 0.4;

impl SunAxis {
    /// `n` nodes from `lowest` to 1.
    pub fn new(n: usize, lowest: f64) -> Self {
        let x = |mu: f64| (mu + SHIFT) / ((mu + SHIFT).abs() + WIDTH);
        let (x0, x1) = (x(lowest), x(1.0));
        let mut mu_s: Vec<f64> = (0..n)
            .map(|k| {
                let x = x0 + (x1 - x0) * k as f64 / (n - 1) as f64;
                x * WIDTH / (1.0 - x.abs()) - SHIFT
            })
            .collect();
        mu_s[0] = lowest;
        mu_s[n - 1] = 1.0;
        let scale = (n - 1) as f64 / (x1 - x0);
        SunAxis { mu_s, lowest: lowest as f32, lowest_x: x0 as f32, scale: scale as f32 }
    }

    /// The same axis with `factor` intervals for each of its own.
    pub fn refined(&self, factor: usize) -> Self {
        SunAxis::new((self.len() - 1) * factor + 1, self.mu_s[0])
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.mu_s.len()
    }

    pub fn is_empty(&self) -> bool {
        self.mu_s.is_empty()
    }

    /// Node below and place between it and the next; below the lowest node the second value is negative and
    /// there is no light.
    #[inline(always)]
    pub fn locate(&self, mu_s: f32) -> (u32, f32) {
        let u = mu_s + SHIFT as f32;
        let x = (u / (u.abs() + WIDTH as f32) - self.lowest_x) * self.scale;
        let (node, t) = node_and_place(x, self.mu_s.len());
        (node, if mu_s < self.lowest { -1.0 } else { t })
    }

    /// The same for a chunk of sun positions; both weights are 0 where it is dark.
    #[inline(always)]
    pub fn places(&self, mu_s: &[f32; CHUNK]) -> Places {
        let mut out = Places::NONE;
        for k in 0..CHUNK {
            let u = mu_s[k] + SHIFT as f32;
            let x = (u / (u.abs() + WIDTH as f32) - self.lowest_x) * self.scale;
            let (n, t) = node_and_place(x, self.mu_s.len());
            let lit = if mu_s[k] < self.lowest { 0.0 } else { 1.0 };
            out.nodes[k] = n;
            out.low[k] = (1.0 - t) * lit;
            out.high[k] = t * lit;
        }
        out
    }
}

/// The node below a place x on an axis of `count` nodes, at most count − 2, and the place 0..1 between it and
/// the next. The integer is read from the bits of x + 2²³: a conversion would saturate, and not vectorise.
#[inline(always)]
pub(crate) fn node_and_place(x: f32, count: usize) -> (u32, f32) {
    const ROUND: f32 = 8_388_608.0;
    let last = (count - 2) as f32;
    let x = if x > 0.0 { x } else { 0.0 };
    let down = if x > 0.5 { x - 0.5 } else { 0.0 };
    let shifted = (if down < last { down } else { last }) + ROUND;
    let t = x - (shifted - ROUND);
    let t = if t < 1.0 { t } else { 1.0 };
    (shifted.to_bits() & 0x007f_ffff, if t > 0.0 { t } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The kernel's single-precision look-up finds the nodes where they were placed.
    #[test]
    fn nodes_are_found_where_they_are() {
        let axis = SunAxis::new(64, -0.31);
        for (k, &mu) in axis.mu_s.iter().enumerate() {
            let (node, t) = axis.locate(mu as f32);
            assert!((f64::from(node) + f64::from(t) - k as f64).abs() < 1e-3, "{k} {mu}: {node} {t}");
        }
        assert!(axis.locate(-0.32).1 < 0.0);
    }
}
