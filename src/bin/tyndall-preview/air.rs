//! Coefficients of the air against altitude, from `bake.json` alone: what a march without tables needs.

use crate::bake::Bake;
use half::f16;
use serde_json::Value;
use tyndall::{Error, Result};

/// Even altitudes from the ground to the top.
const ALTITUDES: usize = 1024;
/// As many groups as the shader of the march sums.
const MOST_GROUPS: usize = 3;

/// 1/km at the four wavelengths: a row of [`ALTITUDES`] for what each group of one phase function scatters, then
/// one of extinction.
pub struct Air {
    pub groups: usize,
    pub size: [usize; 3],
    pub bits: Vec<[u16; 4]>,
}

impl Air {
    /// # Errors
    /// `File` where the manifest does not state the air.
    pub fn new(bake: &Bake) -> Result<Air> {
        read(bake).map_err(|reason| Error::file(&bake.folder, format!("bake.json: {reason}")))
    }
}

fn read(bake: &Bake) -> Result<Air> {
    let groups = bake.constants.counts[0] as usize;
    if groups == 0 || groups > MOST_GROUPS {
        return Err(format!("{groups} groups of phase functions: the march sums 1 to {MOST_GROUPS}").into());
    }
    let mut rows = vec![vec![[0.0; 4]; ALTITUDES]; groups + 1];
    let constituents = bake.manifest.preset.resolved["constituents"].as_array();
    for constituent in constituents.ok_or("preset.resolved.constituents is missing")? {
        let name = constituent["name"].as_str().ok_or("a constituent without a name")?;
        let list = |what: &str| {
            let key = format!("constituent_{name}_{what}");
            bake.manifest.constants.get(&key).ok_or(format!("constants.{key} is missing"))
        };
        let (scattering, extinction) = (list("scattering_at_four_per_m")?, list("extinction_at_four_per_m")?);
        let row = list("phase_row")?.first().map(|r| *r as usize);
        if row.is_some_and(|r| r >= groups) {
            return Err(format!(
                "constituents.{name}: folded into the table of the rest: there is nothing to march"
            )
            .into());
        }
        let [ground, top] = bake.radii();
        for k in 0..ALTITUDES {
            let altitude = (top - ground) * k as f64 / (ALTITUDES - 1) as f64;
            let density = density(&constituent["profile"], altitude)
                .ok_or(format!("constituents.{name}.profile: unknown"))?;
            let add = |texel: &mut [f64; 4], per_m: &[f64]| {
                texel.iter_mut().zip(per_m).for_each(|(t, v)| *t += 1e3 * density * v);
            };
            // What only absorbs has no row.
            if let Some(row) = row {
                add(&mut rows[row][k], scattering);
            }
            add(&mut rows[groups][k], extinction);
        }
    }
    let bits = rows.iter().flatten().map(|t| t.map(|v| f16::from_f32(v as f32).to_bits())).collect();
    Ok(Air { groups, size: [ALTITUDES, groups + 1, 1], bits })
}

/// Relative density of a profile of a resolved preset; none for one of another form.
fn density(profile: &Value, altitude: f64) -> Option<f64> {
    let number = |key: &str| profile[key].as_f64();
    match profile["kind"].as_str()? {
        "exponential" => Some(libm::exp(-altitude / number("scale_height")?)),
        "layer" => Some(f64::from(u8::from(altitude >= number("bottom")? && altitude <= number("top")?))),
        "tent" => {
            let (bottom, centre, top) = (number("bottom")?, number("centre")?, number("top")?);
            let rise = if altitude < centre {
                (altitude - bottom) / (centre - bottom)
            } else {
                (top - altitude) / (top - centre)
            };
            Some(rise.clamp(0.0, 1.0))
        }
        "linear" => between(&profile["nodes"], altitude, |a, b, t| a + (b - a) * t),
        "log_linear" => between(&profile["nodes"], altitude, |a, b, t| a * libm::pow(b / a, t)),
        _ => None,
    }
}

/// Blend of the nodes (altitude, density) around an altitude; 0 outside them.
fn between(nodes: &Value, altitude: f64, blend: impl Fn(f64, f64, f64) -> f64) -> Option<f64> {
    let node = |v: &Value| Some((v.get(0)?.as_f64()?, v.get(1)?.as_f64()?));
    let nodes: Vec<(f64, f64)> = nodes.as_array()?.iter().map(node).collect::<Option<_>>()?;
    let pair = nodes.windows(2).find(|w| w[0].0 <= altitude && altitude <= w[1].0);
    Some(pair.map_or(0.0, |w| blend(w[0].1, w[1].1, (altitude - w[0].0) / (w[1].0 - w[0].0))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Each kind of profile at places where its value is plain: a scale height up, half way up a tent, the
    /// geometric mean half way between nodes of a logarithm, nothing outside.
    #[test]
    fn profiles_by_hand() {
        let at = |profile: Value, altitude: f64| density(&profile, altitude).unwrap();
        assert!((at(json!({"kind": "exponential", "scale_height": 5e3}), 5e3) - 0.367879).abs() < 1e-6);
        let tent = json!({"kind": "tent", "bottom": 1e3, "centre": 3e3, "top": 4e3});
        assert_eq!([at(tent.clone(), 2e3), at(tent.clone(), 3.5e3), at(tent, 5e3)], [0.5, 0.5, 0.0]);
        let nodes = json!([[0.0, 1.0], [1e3, 0.01]]);
        assert!((at(json!({"kind": "log_linear", "nodes": nodes}), 500.0) - 0.1).abs() < 1e-12);
        assert_eq!(at(json!({"kind": "linear", "nodes": nodes}), 2e3), 0.0);
        assert_eq!(density(&json!({"kind": "new"}), 0.0), None);
    }
}
