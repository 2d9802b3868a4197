//! Numbers between 0 and 1 for a path: an Owen-scrambled Sobol sequence for its first events, a counter-based
//! generator after them. Everything follows from (seed, replicate, path), so no order of work can change it.

/// Samples that one scrambled Sobol sequence of `sobol_burley` has.
pub const SEQUENCE: u64 = 1 << 16;
/// Events, of four numbers each, that the sequence covers.
const EVENTS: u32 = 12;

pub struct Numbers {
    index: u32,
    scramble: u32,
    state: u64,
    event: u32,
}

impl Numbers {
    pub fn new(seed: u64, replicate: u64, path: u64) -> Self {
        let sequence =
            mix(mix(seed ^ 0x9e37_79b9_7f4a_7c15).wrapping_add(replicate)).wrapping_add(path / SEQUENCE);
        let key = mix(sequence);
        Numbers {
            index: (path % SEQUENCE) as u32,
            scramble: (key >> 32) as u32,
            state: mix(key ^ mix(path)),
            event: 0,
        }
    }

    /// The four numbers of the next event.
    #[inline]
    pub fn event(&mut self) -> [f64; 4] {
        let n = self.event;
        self.event += 1;
        if n >= EVENTS {
            return [self.uniform(), self.uniform(), self.uniform(), self.uniform()];
        }
        // The sequence has 24 bits; random ones follow, so that a number may be cut up and used again.
        let fill = self.bits();
        let s = sobol_burley::sample_4d(self.index, n, self.scramble);
        std::array::from_fn(|k| {
            let low = ((fill >> (16 * k)) & 0xffff) as f64 + 0.5;
            f64::from(s[k]).min(1.0 - 1.0 / 16_777_216.0) + low / (16_777_216.0 * 65_536.0)
        })
    }

    /// A number that belongs to no sequence, in (0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 12) as f64 + 0.5) / 4_503_599_627_370_496.0
    }

    #[inline]
    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.state)
    }
}

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
#[inline]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
