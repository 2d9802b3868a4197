//! Choices from bytes: as long as there are some; then the first of each.

pub struct Choices<'a> {
    bytes: std::slice::Iter<'a, u8>,
    /// What takes long may be chosen too.
    pub heavy: bool,
}

impl<'a> Choices<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Choices { bytes: bytes.iter(), heavy: false }
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.bytes.next().map_or(0, |&byte| usize::from(byte) % n)
    }

    pub fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// Once in so many times.
    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) + 1 == n
    }

    /// 0 to 1, both among them.
    pub fn share(&mut self) -> f64 {
        (256 * self.below(256) + self.below(256)) as f64 / 65535.0
    }

    /// Between two positive numbers, even in the logarithm.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        let mut ratio = high / low;
        let mut out = low;
        for byte in [self.below(256), self.below(256)] {
            for bit in (0..8).rev() {
                ratio = ratio.sqrt();
                if byte >> bit & 1 == 1 {
                    out *= ratio;
                }
            }
        }
        out
    }
}
