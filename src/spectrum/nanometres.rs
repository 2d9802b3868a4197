//! A spectrum as one value a nanometre, such that sums over whole nanometres see all of it.

use super::Spectrum;
use super::observer::OBSERVER_RANGE;

/// The spectrum at every whole nanometre of the observer's range, end values held.
///
/// Where its nodes in the range are a nanometre apart or more these are its values, as the CIE has it. Else something may
/// lie between them, as a laser's line does, and each is the mean under a hat that falls to 0 one nanometre away on both sides: then Σ value ·
/// x̄ · 1 nm is ∫ spectrum · x̄ with both linear between their nodes, to the last bit of the line.
pub fn at_nanometres(spectrum: &Spectrum) -> Vec<f64> {
    let (from, to) = (OBSERVER_RANGE.0 as f64, OBSERVER_RANGE.1 as f64);
    let between: Vec<f64> = spectrum.nodes().map(|n| n.0).filter(|w| (from..to).contains(w)).collect();
    if between.windows(2).all(|pair| pair[1] - pair[0] >= 1.0) {
        return (OBSERVER_RANGE.0..=OBSERVER_RANGE.1).map(|w| spectrum.at(w as f64)).collect();
    }
    means(spectrum, &between)
}

/// Means under hats; `nodes` are those of the spectrum in the range.
fn means(spectrum: &Spectrum, nodes: &[f64]) -> Vec<f64> {
    let (first, last) = OBSERVER_RANGE;
    let mut out = vec![0.0; last - first + 1];
    let mut nodes = nodes.iter().copied().peekable();
    for k in 0..last - first {
        let (low, high) = ((first + k) as f64, (first + k + 1) as f64);
        let mut at = low;
        while at < high {
            while nodes.next_if(|&node| node <= at).is_some() {}
            let to = nodes.peek().map_or(high, |&node| node.min(high));
            let [down, up] = parts(spectrum, [at, to], low);
            out[k] += down;
            out[k + 1] += up;
            at = to;
        }
    }
    // The halves of the outer hats that lie beyond the range: end values are held there.
    out[0] += 0.5 * spectrum.at(first as f64);
    out[last - first] += 0.5 * spectrum.at(last as f64);
    out
}

/// ∫ of a piece without a node inside, under the hat that falls from 1 at `low`, and under the one that rises from 0
/// there. Simpson's rule, which is exact for products of two straight lines.
fn parts(spectrum: &Spectrum, [a, b]: [f64; 2], low: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (at, weight) in [(a, 1.0), (0.5 * (a + b), 4.0), (b, 1.0)] {
        let value = weight * spectrum.at(at);
        sums[0] += value * (low + 1.0 - at);
        sums[1] += value * (at - low);
    }
    sums.map(|sum| sum * (b - a) / 6.0)
}

#[cfg(test)]
mod tests {
    use super::super::Observer;
    use super::*;

    fn xyz(spectrum: &Spectrum) -> [f64; 3] {
        let values = at_nanometres(spectrum);
        Observer::cie1931().xyz(|w| values[w as usize - OBSERVER_RANGE.0])
    }

    /// A line of a fifth of a nanometre that no whole one meets has its area, 100, times the observer where it stands: to
    /// the curvature of x̄ over a nanometre.
    #[test]
    fn a_narrow_line_is_not_missed() {
        for centre in [532.3, 532.0, 611.95, 450.5] {
            let w = vec![360.0, centre - 0.1, centre, centre + 0.1, 830.0];
            let line = Spectrum::new(w, vec![0.0, 0.0, 1000.0, 0.0, 0.0]).unwrap();
            let there = Observer::cie1931().at(centre);
            for (found, wanted) in xyz(&line).iter().zip(there) {
                assert!((found - 100.0 * wanted).abs() < 0.02 * 100.0 * wanted, "{centre}: {found} {wanted}");
            }
        }
    }

    /// A straight line with nodes anywhere, and a constant from an odd place on, are what they are on whole nanometres.
    #[test]
    fn smooth_spectra_stay_as_they_are() {
        let line = |w: f64| 2.0 + 0.01 * w;
        let plain = Spectrum::sampled(vec![360.0, 830.0], line).unwrap();
        let odd = Spectrum::sampled(vec![300.0, 412.3, 412.35, 700.8, 900.0], line).unwrap();
        for (found, wanted) in at_nanometres(&odd)[1..470].iter().zip(&at_nanometres(&plain)[1..]) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
        let constant = Spectrum::new(vec![400.3, 500.7], vec![3.0, 3.0]).unwrap();
        assert!(at_nanometres(&constant).iter().all(|v| (v - 3.0).abs() < 1e-12));
    }

    /// Nodes a nanometre apart or more are sampled to the bit, wherever they lie and the spectrum begins and ends.
    #[test]
    fn coarse_spectra_are_sampled() {
        for at in [400.0, 408.571] {
            let nodes = vec![300.5, at, at + 1.0, 500.0, 900.5];
            let s = Spectrum::new(nodes, vec![0.1, 0.7, 0.3, 5.0, 1.0]).unwrap();
            let values = at_nanometres(&s);
            assert!((360..=830).all(|w| values[w - 360].to_bits() == s.at(w as f64).to_bits()));
        }
    }
}
