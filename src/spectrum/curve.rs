//! A quantity against wavelength.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// A quantity against wavelength: linear between nodes, the end values held outside; or one constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Nodes")]
pub struct Spectrum {
    /// Rising, nm; empty for a constant.
    wavelengths_nm: Vec<f64>,
    /// One value a wavelength; a single one for a constant.
    values: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Nodes {
    wavelengths_nm: Vec<f64>,
    values: Vec<f64>,
}

impl TryFrom<Nodes> for Spectrum {
    type Error = Error;

    fn try_from(nodes: Nodes) -> Result<Self> {
        match (nodes.wavelengths_nm.as_slice(), nodes.values.as_slice()) {
            ([], [value]) if value.is_finite() => Ok(Spectrum::constant(*value)),
            _ => Spectrum::new(nodes.wavelengths_nm, nodes.values),
        }
    }
}

impl Spectrum {
    /// The same value at every wavelength.
    pub fn constant(value: f64) -> Self {
        Spectrum { wavelengths_nm: Vec::new(), values: vec![value] }
    }

    /// A spectrum through nodes. Refuses empty or unequal lists, wavelengths that do not rise, and numbers
    /// that are not finite.
    pub fn new(wavelengths_nm: Vec<f64>, values: Vec<f64>) -> Result<Self> {
        let refuse = |reason: String| Err(Error::Argument(format!("spectrum: {reason}")));
        if wavelengths_nm.is_empty() {
            return refuse("no values".into());
        }
        if wavelengths_nm.len() != values.len() {
            return refuse(format!("{} wavelengths but {} values", wavelengths_nm.len(), values.len()));
        }
        if let Some(bad) = wavelengths_nm.iter().find(|w| !(w.is_finite() && **w > 0.0)) {
            return refuse(format!("wavelength {bad} nm is not a positive number"));
        }
        if let Some(pair) = wavelengths_nm.windows(2).find(|p| p[1] <= p[0]) {
            return refuse(format!("wavelengths must rise, but {} nm follows {} nm", pair[1], pair[0]));
        }
        if let Some(k) = values.iter().position(|v| !v.is_finite()) {
            return refuse(format!("value {} at {} nm is not finite", values[k], wavelengths_nm[k]));
        }
        Ok(Spectrum { wavelengths_nm, values })
    }

    /// A function sampled at rising wavelengths.
    pub fn sampled(wavelengths_nm: Vec<f64>, f: impl Fn(f64) -> f64) -> Result<Self> {
        let values = wavelengths_nm.iter().map(|&w| f(w)).collect();
        Spectrum::new(wavelengths_nm, values)
    }

    /// Value at a wavelength (nm), in the spectrum's unit.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let (w, v) = (&self.wavelengths_nm, &self.values);
        let after = w.partition_point(|&x| x <= wavelength_nm);
        if after == 0 {
            return v[0];
        }
        if after == w.len() {
            return v[after - 1];
        }
        let t = (wavelength_nm - w[after - 1]) / (w[after] - w[after - 1]);
        v[after - 1] + (v[after] - v[after - 1]) * t
    }

    /// Values at a list of wavelengths (nm).
    pub fn at_all(&self, wavelengths_nm: &[f64]) -> Vec<f64> {
        wavelengths_nm.iter().map(|&w| self.at(w)).collect()
    }

    /// The part of `from..to` (nm) that the nodes do not reach and where an end value is held, if any.
    pub fn held_outside(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let (first, last) = (*self.wavelengths_nm.first()?, *self.wavelengths_nm.last()?);
        (first > from || last < to).then_some((first, last))
    }

    /// True where nodes reach over `from..=to` (nm), so that no end value is held; always for a constant.
    pub fn covers(&self, from: f64, to: f64) -> bool {
        self.held_outside(from, to).is_none()
    }

    /// Least and greatest node value.
    pub fn range(&self) -> (f64, f64) {
        self.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)))
    }

    /// Nodes (wavelength in nm, value); none for a constant.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.wavelengths_nm.iter().copied().zip(self.values.iter().copied())
    }

    /// True for a constant.
    pub fn is_constant(&self) -> bool {
        self.wavelengths_nm.is_empty()
    }

    /// The same spectrum times a factor.
    pub fn scaled(&self, factor: f64) -> Self {
        let values = self.values.iter().map(|v| v * factor).collect();
        Spectrum { wavelengths_nm: self.wavelengths_nm.clone(), values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear between nodes (a quarter of the way from 2 to 10 is 4), end values held outside and reported.
    #[test]
    fn linear_inside_and_held_outside() {
        let s = Spectrum::new(vec![400.0, 500.0], vec![2.0, 10.0]).unwrap();
        assert_eq!([s.at(425.0), s.at(400.0), s.at(500.0)], [4.0, 2.0, 10.0]);
        assert_eq!([s.at(380.0), s.at(780.0)], [2.0, 10.0]);
        assert!(s.covers(400.0, 500.0) && !s.covers(399.0, 500.0));
        assert_eq!(s.held_outside(380.0, 780.0), Some((400.0, 500.0)));
        assert!(Spectrum::constant(3.0).covers(1.0, 1e6));
        assert_eq!(Spectrum::constant(3.0).at(42.0), 3.0);
    }

    /// Lists that describe no function are refused, each with its reason.
    #[test]
    fn bad_nodes_are_refused() {
        for (w, v, reason) in [
            (vec![], vec![], "no values"),
            (vec![500.0], vec![1.0, 2.0], "1 wavelengths but 2 values"),
            (vec![500.0, 500.0], vec![1.0, 2.0], "must rise"),
            (vec![500.0, 600.0], vec![1.0, f64::NAN], "not finite"),
            (vec![-500.0, 600.0], vec![1.0, 2.0], "not a positive number"),
        ] {
            let error = Spectrum::new(w, v).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }

    /// Text and back gives the same bits: manifests hold spectra this way.
    #[test]
    fn json_keeps_every_bit() {
        let s = Spectrum::new(vec![400.1, 500.3], vec![0.1 + 0.2, 1e-300]).unwrap();
        let text = serde_json::to_string(&s).unwrap();
        assert_eq!(serde_json::from_str::<Spectrum>(&text).unwrap(), s);
        assert!(serde_json::from_str::<Spectrum>(r#"{"wavelengths_nm":[2,1],"values":[1,1]}"#).is_err());
    }
}
