//! Numbers between 0 and 1 for a path: an Owen-scrambled Sobol sequence for its first events, a counter-based
//! generator after them. Everything follows from (seed, replicate, path), so no order of work can change it.

/// Samples that one scrambled Sobol sequence of `sobol_burley` has.
pub(super) const SEQUENCE: u64 = 1 << 16;
/// Events, of four numbers each, that the sequence covers.
const EVENTS: usize = 12;

/// The sequence's part in a path.
pub(super) struct Numbers {
    index: u32,
    scramble: u32,
}

/// Numbers that belong to no sequence; each ray of a path and of its copies has its own, so that what one
/// ray draws does not depend on how long others live.
#[derive(Clone, Copy)]
pub(super) struct Stream(u64);

impl Numbers {
    /// The numbers of a path and the stream of its first ray.
    pub(super) fn new(seed: u64, replicate: u64, path: u64) -> (Self, Stream) {
        let key = mix(mix(seed ^ GOLDEN).wrapping_add(replicate));
        let key = mix(key.wrapping_add(path / SEQUENCE));
        let numbers = Numbers { index: (path % SEQUENCE) as u32, scramble: (key >> 32) as u32 };
        (numbers, Stream(mix(key ^ mix(path))))
    }

    /// The four numbers of an event (counted from 0), from the sequence unless they are for a copy.
    #[inline]
    pub(super) fn event(&self, event: usize, copy: bool, stream: &mut Stream) -> [f64; 4] {
        if copy || event >= EVENTS {
            return [stream.uniform(), stream.uniform(), stream.uniform(), stream.uniform()];
        }
        // The sequence has 24 bits; random ones follow, so that a number may be cut up and used again.
        let fill = stream.bits();
        let s = sobol_burley::sample_4d(self.index, event as u32, self.scramble);
        std::array::from_fn(|k| {
            let low = ((fill >> (16 * k)) & 0xffff) as f64 + 0.5;
            f64::from(s[k]).min(1.0 - 1.0 / 16_777_216.0) + low / (16_777_216.0 * 65_536.0)
        })
    }
}

impl Stream {
    /// A number in (0, 1).
    #[inline]
    pub(super) fn uniform(&mut self) -> f64 {
        ((self.bits() >> 12) as f64 + 0.5) / 4_503_599_627_370_496.0
    }

    /// A stream of its own.
    #[inline]
    pub(super) fn branch(&mut self) -> Stream {
        Stream(mix(self.bits() ^ GOLDEN))
    }

    #[inline]
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
#[inline]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
