//! CIELAB and the CIEDE2000 colour difference.

/// XYZ of D65 at Y = 1, from its chromaticity (0.3127, 0.3290), which is sRGB's white too.
pub const D65: [f64; 3] = [0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290];

/// Luminance to which a reference colour is scaled before a difference is taken: an object of 18 %
/// reflectance in a scene exposed for it, so that a dark sky counts as a camera or an adapted eye sees it.
const REFERENCE_Y: f64 = 0.18;

/// CIELAB coordinates (CIE 15:2004).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    pub l: f64,
    pub a: f64,
    pub b: f64,
}

/// CIELAB of XYZ relative to a white in the same unit (CIE 15:2004, Eqs. 8.3–8.11).
pub fn lab_of_xyz(xyz: [f64; 3], white: [f64; 3]) -> Lab {
    const LIMIT: f64 = 6.0 / 29.0;
    let f = |t: f64| {
        if t > LIMIT * LIMIT * LIMIT { libm::cbrt(t) } else { t / (3.0 * LIMIT * LIMIT) + 4.0 / 29.0 }
    };
    let [x, y, z] = [f(xyz[0] / white[0]), f(xyz[1] / white[1]), f(xyz[2] / white[2])];
    Lab { l: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) }
}

/// ΔE2000 of two colours in XYZ by the project's rule: white D65, both scaled by the factor that gives the
/// reference Y = 0.18. Infinite where the reference is black and the other is not.
pub fn delta_e_2000_scaled(reference: [f64; 3], other: [f64; 3]) -> f64 {
    if reference[1] <= 0.0 {
        return if other == reference { 0.0 } else { f64::INFINITY };
    }
    let scale = REFERENCE_Y / reference[1];
    delta_e_2000(lab_of_xyz(reference.map(|v| v * scale), D65), lab_of_xyz(other.map(|v| v * scale), D65))
}

/// ΔE2000 of two CIELAB colours, weights k_L = k_C = k_H = 1 (Sharma, Wu & Dalal 2005, Eqs. 2–22).
pub fn delta_e_2000(one: Lab, two: Lab) -> f64 {
    let chroma = |c: Lab| (c.a * c.a + c.b * c.b).sqrt();
    let seventh = saturation(0.5 * (chroma(one) + chroma(two)));
    let g = 0.5 * (1.0 - seventh);
    let (a1, a2) = ((1.0 + g) * one.a, (1.0 + g) * two.a);
    let (c1, c2) = ((a1 * a1 + one.b * one.b).sqrt(), (a2 * a2 + two.b * two.b).sqrt());
    let (h1, h2) = (hue(a1, one.b), hue(a2, two.b));
    let both = c1 * c2 > 0.0;

    let turn = if both { wrap(h2 - h1) } else { 0.0 };
    let hue_difference = 2.0 * (c1 * c2).sqrt() * sin_deg(0.5 * turn);
    let mean_hue = if !both {
        h1 + h2
    } else if (h1 - h2).abs() <= 180.0 {
        0.5 * (h1 + h2)
    } else if h1 + h2 < 360.0 {
        0.5 * (h1 + h2 + 360.0)
    } else {
        0.5 * (h1 + h2 - 360.0)
    };
    let (mean_l, mean_c) = (0.5 * (one.l + two.l), 0.5 * (c1 + c2));

    let t = 1.0 - 0.17 * cos_deg(mean_hue - 30.0)
        + 0.24 * cos_deg(2.0 * mean_hue)
        + 0.32 * cos_deg(3.0 * mean_hue + 6.0)
        - 0.20 * cos_deg(4.0 * mean_hue - 63.0);
    let from_blue = (mean_hue - 275.0) / 25.0;
    let rotation = 30.0 * libm::exp(-from_blue * from_blue);
    let from_grey = (mean_l - 50.0) * (mean_l - 50.0);
    let s_l = 1.0 + 0.015 * from_grey / (20.0 + from_grey).sqrt();
    let s_c = 1.0 + 0.045 * mean_c;
    let s_h = 1.0 + 0.015 * mean_c * t;
    let r_t = -sin_deg(2.0 * rotation) * 2.0 * saturation(mean_c);

    let (l, c, h) = ((two.l - one.l) / s_l, (c2 - c1) / s_c, hue_difference / s_h);
    (l * l + c * c + h * h + r_t * c * h).max(0.0).sqrt()
}

/// √(C⁷ / (C⁷ + 25⁷)).
fn saturation(chroma: f64) -> f64 {
    let seventh = libm::pow(chroma, 7.0);
    (seventh / (seventh + 6_103_515_625.0)).sqrt()
}

/// Hue angle, degrees 0..360; 0 for a grey.
fn hue(a: f64, b: f64) -> f64 {
    if a == 0.0 && b == 0.0 {
        return 0.0;
    }
    let degrees = libm::atan2(b, a).to_degrees();
    if degrees < 0.0 { degrees + 360.0 } else { degrees }
}

/// An angle between −360° and 360° brought to −180..180.
fn wrap(degrees: f64) -> f64 {
    if degrees > 180.0 {
        degrees - 360.0
    } else if degrees < -180.0 {
        degrees + 360.0
    } else {
        degrees
    }
}

fn sin_deg(degrees: f64) -> f64 {
    libm::sin(degrees.to_radians())
}

fn cos_deg(degrees: f64) -> f64 {
    libm::cos(degrees.to_radians())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of Sharma, Wu & Dalal 2005, Table 1, that exercise hue wrap, greys, the blue rotation and large
    /// differences; printed to four decimals there.
    #[test]
    fn sharma_pairs() {
        let pairs = [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
            ([50.0, -0.001, 2.49], [50.0, 0.0011, -2.49], 4.7461),
            ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
            ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
            ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
            ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
        ];
        let lab = |v: [f64; 3]| Lab { l: v[0], a: v[1], b: v[2] };
        for (one, two, expected) in pairs {
            let (there, back) = (delta_e_2000(lab(one), lab(two)), delta_e_2000(lab(two), lab(one)));
            assert!((there - expected).abs() < 5e-5, "{one:?} {two:?}: {there}");
            assert!((there - back).abs() < 1e-12, "the difference is symmetric");
        }
    }

    /// White is L* = 100 without colour, and a grey of 18 % is L* = 49.496.
    #[test]
    fn greys_have_no_colour() {
        let white = lab_of_xyz(D65, D65);
        assert!((white.l - 100.0).abs() < 1e-12 && white.a.abs() < 1e-12 && white.b.abs() < 1e-12);
        let grey = lab_of_xyz(D65.map(|v| 0.18 * v), D65);
        assert!((grey.l - 49.496).abs() < 1e-3);
    }

    /// The scaled difference does not see the unit: a sky in cd/m² and the same in kcd/m² are alike.
    #[test]
    fn scaling_takes_the_unit_away() {
        let (one, two) = ([3000.0, 3200.0, 5000.0], [3100.0, 3150.0, 5100.0]);
        let d = delta_e_2000_scaled(one, two);
        let small = delta_e_2000_scaled(one.map(|v| v * 1e-7), two.map(|v| v * 1e-7));
        assert!(d > 1.0 && (d - small).abs() < 1e-9);
        assert_eq!(delta_e_2000_scaled([0.0; 3], [0.0; 3]), 0.0);
        assert_eq!(delta_e_2000_scaled([0.0; 3], one), f64::INFINITY);
    }
}
