//! The part of its axes that a table holds, where a scene needs no more.
//!
//! A window leaves the mapping as it is and cuts a piece out of its coordinates: what lay between two of them is spread
//! over the texels, so that a smaller table is as fine as a whole one. An axis of one texel holds the middle of its
//! piece.

/// Altitudes, suns and views that tables are for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Window {
    /// Lowest and highest altitude of observers, m; those above the shell look in from its top. None: all.
    pub altitudes: Option<[f64; 2]>,
    /// Lowest and highest elevation of the sun over the observer's horizontal, degrees. None: all.
    pub suns: Option<[f64; 2]>,
    pub views: Views,
}

/// Which rays tables hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Views {
    #[default]
    All,
    /// Those that do not meet the ground: half of the view axis.
    Sky,
}

impl Window {
    /// All that there is.
    pub const WHOLE: Window = Window { altitudes: None, suns: None, views: Views::All };

    /// What a table of optical depth has to hold: sunlight on the ground is looked up from the ground, whoever sees it.
    pub fn of_depth(&self) -> Window {
        Window { altitudes: self.altitudes.map(|[_, high]| [0.0, high]), suns: None, views: self.views }
    }

    /// Lowest and highest altitude inside a shell of this height, m.
    pub fn altitudes_in(&self, height: f64) -> [f64; 2] {
        self.altitudes.map_or([0.0, height], |ends| ends.map(|a| a.clamp(0.0, height)))
    }

    /// Cosines of the lowest and the highest sun at places where rays are looked up, in a shell between two radii. An
    /// observer above it looks up where the ray enters: there the vertical is turned by the angle about the planet's
    /// centre, which is largest for a ray that grazes the shell.
    pub fn suns_in(&self, ground: f64, top: f64) -> Option<[f64; 2]> {
        let [low, high] = self.suns?;
        let highest = ground + self.altitudes.map_or(0.0, |ends| ends[1]);
        let turn = if highest > top { libm::acos(top / highest).to_degrees() } else { 0.0 };
        let cosine = |degrees: f64| libm::sin(degrees.clamp(-90.0, 90.0).to_radians());
        Some([cosine(low - turn), cosine(high + turn)])
    }
}

/// A piece of an axis, from one coordinate 0..1 to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub low: f64,
    pub high: f64,
}

impl Span {
    pub const WHOLE: Span = Span { low: 0.0, high: 1.0 };

    /// None where the ends are no coordinates, or the wrong way round.
    pub fn new(low: f64, high: f64) -> Option<Span> {
        (0.0 <= low && low <= high && high <= 1.0).then_some(Span { low, high })
    }

    /// Place of a coordinate in the piece: 0 and 1 at its ends, beyond them outside it; 0 in one without extent.
    #[inline]
    pub fn place(&self, coordinate: f64) -> f64 {
        if self.high > self.low { (coordinate - self.low) / (self.high - self.low) } else { 0.0 }
    }

    /// Coordinate of texel `k` of `size`.
    #[inline]
    pub fn coordinate(&self, k: usize, size: usize) -> f64 {
        let share = if size > 1 { k as f64 / (size - 1) as f64 } else { 0.5 };
        self.low + (self.high - self.low) * share
    }

    /// Texels that are as close as those of a whole axis of `size`: one where there is no extent.
    pub fn texels(&self, size: usize) -> usize {
        let steps = (self.high - self.low) * size.saturating_sub(1) as f64;
        if steps > 0.0 { (steps - 1e-9).ceil().max(1.0) as usize + 1 } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends of a piece are ends of the table; one texel is the middle; a piece keeps the whole axis' closeness.
    #[test]
    fn spans_are_affine() {
        let span = Span::new(0.2, 0.6).unwrap();
        for k in 0..5 {
            assert!((span.place(span.coordinate(k, 5)) - k as f64 / 4.0).abs() < 1e-15);
        }
        assert_eq!((span.coordinate(0, 1), span.texels(11), span.texels(41)), (0.4, 5, 17));
        let point = Span::new(0.3, 0.3).unwrap();
        assert_eq!((point.place(0.9), point.coordinate(0, 1), point.texels(99)), (0.0, 0.3, 1));
        assert_eq!((Span::WHOLE.place(0.37), Span::WHOLE.texels(24)), (0.37, 24));
        assert!(Span::new(0.6, 0.2).is_none() && Span::new(f64::NAN, 0.2).is_none());
    }

    /// From a radius of twice the shell's, rays that graze it enter 60 degrees away: a sun at 20 degrees stands between
    /// -40 and 80 there. Observers inside look up where they are.
    #[test]
    fn suns_widen_for_observers_outside() {
        let inside = Window { altitudes: Some([0.0, 5.0]), suns: Some([20.0, 20.0]), views: Views::All };
        let sine = |degrees: f64| libm::sin(degrees.to_radians());
        assert_eq!(inside.suns_in(1000.0, 1010.0).unwrap(), [sine(20.0); 2]);
        let outside = Window { altitudes: Some([0.0, 1020.0]), ..inside };
        let [low, high] = outside.suns_in(1000.0, 1010.0).unwrap();
        assert!((low - sine(-40.0)).abs() < 1e-12 && (high - sine(80.0)).abs() < 1e-12);
        assert_eq!(outside.altitudes_in(10.0), [0.0, 10.0]);
        assert_eq!(Window::WHOLE.suns_in(1000.0, 1010.0), None);
    }
}
