//! `tyndall colour`: spectra to XYZ, chromaticity, linear RGB and CIELAB.

use super::colour_input::{Input, Named, black_body, read};
use super::colour_views::{Illuminant, Light, illuminant, tell_of_views};
use super::text::{number, print, say};
use crate::error::Result;
use crate::spectrum::*;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Spectra as CSV to XYZ, xy, linear RGB and CIELAB.
///
/// XYZ = k Σ spectrum · (x̄, ȳ, z̄) · 1 nm over 360–830 nm with the CIE 1931 2° observer; the spectrum is linear
/// between its samples, end values are held. One with samples less than a nanometre apart is integrated as it is given,
/// so that no line falls between whole nanometres. (ASTM E308 in its practice range stops at 780 nm: 2e-6 less X for a white.)
///
/// Views of `tyndall sample` and `tyndall reference` are radiance over the star's irradiance. They are taken under
/// --illuminant, and Y = 100 is a white surface that this light meets squarely:
/// tyndall sample out/earth --points views.csv | tyndall colour
#[derive(clap::Args, Debug)]
#[command(before_help = "Example: tyndall colour --blackbody 5778
         tyndall colour spectra.csv --scale photometric --json")]
pub struct Args {
    /// CSV with a column wavelength_nm and one column a spectrum, or the answer of `tyndall sample`; standard input
    /// without it or with `-`
    pub file: Option<PathBuf>,
    /// A black body of this temperature in K instead of a file; repeatable. Y is 100, unless --scale photometric or
    /// --white-y asks for its radiance, W/(m² sr nm)
    #[arg(long, value_name = "KELVIN")]
    pub blackbody: Vec<f64>,
    /// What XYZ count in
    #[arg(long, value_enum, default_value = "relative")]
    pub scale: Scale,
    /// The Y that is white: RGB (1, 1, 1) and L* = 100 [default: 100 if relative, 1 if photometric]
    #[arg(long, value_name = "Y")]
    pub white_y: Option<f64>,
    /// Of views: the star's irradiance that their values are over. sun (at 1 au), e (equal energy), a CSV file in
    /// W/(m² nm), or none where they are radiance (sample --absolute) [default: sun]
    #[arg(long, value_name = "LIGHT", value_parser = illuminant)]
    pub illuminant: Option<Illuminant>,
    /// Linear RGB space
    #[arg(long, value_enum, default_value = "srgb")]
    pub colour_space: ColourSpace,
    /// What becomes the white of the space: an illuminant or x,y [default: nothing is adapted]
    #[arg(long, value_name = "WHITE", value_parser = White::parse)]
    pub white: Option<White>,
    /// How --white is adapted
    #[arg(long, value_enum, default_value = "bradford", requires = "white")]
    pub adaptation: Adaptation,
    /// Whose colours are meant
    #[arg(long, value_enum, default_value = "cie1931-2deg")]
    pub observer: StandardObserver,
    /// Add the ΔE2000 of each spectrum from the first (D65, both scaled so that the first has Y = 0.18)
    #[arg(long)]
    pub difference: bool,
    /// Print the 1 nm spectra that are summed, and no colours
    #[arg(long)]
    pub spectra: bool,
    /// Print the matrices between XYZ and the colour space (with --white: adaptation included), and no colours
    #[arg(long)]
    pub matrix: bool,
    /// JSON instead of CSV
    #[arg(long)]
    pub json: bool,
}

/// Units of XYZ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Scale {
    /// k = 100 / Σȳ: the equal-energy spectrum of value 1 has Y = 100
    Relative,
    /// k = 683 lm/W: cd/m² for W/(m² sr nm), lx for W/(m² nm)
    Photometric,
}

impl Scale {
    fn k(self, observer: &Observer) -> f64 {
        match self {
            Scale::Relative => 100.0 / observer.xyz(|_| 1.0)[1],
            Scale::Photometric => LUMINOUS_EFFICACY,
        }
    }

    fn default_white(self) -> f64 {
        match self {
            Scale::Relative => 100.0,
            Scale::Photometric => 1.0,
        }
    }
}

/// The colours of one spectrum.
struct Colour {
    name: String,
    xyz: [f64; 3],
    xy: [f64; 2],
    rgb: [f64; 3],
    lab: Lab,
    difference: Option<f64>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    if args.white == Some(White::Star) {
        return Err(crate::Error::Argument("--white star: there is no star here".into()));
    }
    if args.matrix {
        return print(&matrices(args));
    }
    let Input { spectra, are_views } = if args.blackbody.is_empty() {
        read(args.file.as_deref())?
    } else if args.file.is_some() {
        return Err(crate::Error::Argument("give a file or --blackbody, not both".into()));
    } else {
        let spectra = args.blackbody.iter().map(|&t| black_body(t)).collect::<Result<_>>()?;
        Input { spectra, are_views: false }
    };
    if let Some(white) = args.white_y.filter(|w| !(w.is_finite() && *w > 0.0)) {
        return Err(crate::Error::Argument(format!("--white-y {white}: must be greater than 0")));
    }
    let light = Light::of(are_views, args.illuminant.as_ref())?;
    if are_views {
        tell_of_views(&spectra, light.as_ref());
    } else {
        warn_of_held_ends(&spectra);
    }
    if args.spectra {
        return print(&spectra_csv(&spectra, light.as_ref()));
    }
    let colours = colours(args, &spectra, light.as_ref());
    warn_of_brightness(args, &colours);
    print(&if args.json { as_json(args, &colours, light.as_ref()) } else { as_csv(args, &colours) })
}

fn warn_of_held_ends(spectra: &[Named]) {
    let (from, to) = OBSERVER_RANGE;
    for s in spectra {
        if let Some((first, last)) = s.spectrum.held_outside(from as f64, to as f64) {
            say(&format!(
                "warning: {} covers {first}–{last} nm; its end values are held over {from}–{to} nm",
                s.name
            ));
        }
    }
}

/// RGB and L* far beyond white are no colours that anybody sees: the unit is not what the scale counts in.
fn warn_of_brightness(args: &Args, colours: &[Colour]) {
    let white = white_y(args);
    let bright: Vec<&Colour> = colours.iter().filter(|c| c.xyz[1] > 10.0 * white).collect();
    let Some(first) = bright.first() else { return };
    let more = if bright.len() > 1 { format!(" and {} more", bright.len() - 1) } else { String::new() };
    let (name, y) = (&first.name, number(first.xyz[1]));
    say(&format!(
        "warning: {name}{more}: Y = {y}, but white is Y = {white}: RGB and L* count from there; see --white-y"
    ));
}

/// The Y that is white.
fn white_y(args: &Args) -> f64 {
    args.white_y.unwrap_or(args.scale.default_white())
}

/// A spectrum at whole nanometres, under a light where it is a view.
fn nanometres(s: &Named, light: Option<&Light>) -> Vec<f64> {
    let values = at_nanometres(&s.spectrum);
    match light {
        Some(light) => values.iter().zip(&light.irradiance).map(|(v, e)| v * e).collect(),
        None => values,
    }
}

/// The k of all spectra; none where each is brought to Y = 100.
fn k(args: &Args, light: Option<&Light>) -> Option<f64> {
    let observer = args.observer.observer();
    match (args.scale, light) {
        (Scale::Relative, Some(light)) => Some(light.k(observer)),
        (Scale::Relative, None) if !args.blackbody.is_empty() && args.white_y.is_none() => None,
        (scale, _) => Some(scale.k(observer)),
    }
}

fn colours(args: &Args, spectra: &[Named], light: Option<&Light>) -> Vec<Colour> {
    let (white_y, to_rgb) = (white_y(args), from_xyz(args));
    let (observer, k) = (args.observer.observer(), k(args, light));
    let xyz_of = |s: &Named| {
        let values = nanometres(s, light);
        let sums = observer.xyz(|w| values[w as usize - OBSERVER_RANGE.0]);
        let k = k.unwrap_or(100.0 / sums[1]);
        sums.map(|v| v * k)
    };
    let first = xyz_of(&spectra[0]);
    let colour = |s: &Named| {
        let xyz = xyz_of(s);
        let relative = xyz.map(|v| v / white_y);
        Colour {
            name: s.name.clone(),
            xyz,
            xy: chromaticity(xyz),
            rgb: multiply(&to_rgb, relative),
            lab: lab_of_xyz(relative, D65),
            difference: args.difference.then(|| delta_e_2000_scaled(first, xyz)),
        }
    };
    spectra.iter().map(colour).collect()
}

/// XYZ to linear RGB, adaptation included.
fn from_xyz(args: &Args) -> [[f64; 3]; 3] {
    let white = args.white.map(|white| (white, args.adaptation));
    Rgb { space: args.colour_space, white }.under(D65).from_xyz
}

fn as_csv(args: &Args, colours: &[Colour]) -> String {
    let mut out = String::from("name,X,Y,Z,x,y,R,G,B,L*,a*,b*");
    out.push_str(if args.difference { ",delta_e_2000\n" } else { "\n" });
    for c in colours {
        let lab = [c.lab.l, c.lab.a, c.lab.b];
        let values = c.xyz.iter().chain(&c.xy).chain(&c.rgb).chain(&lab).chain(&c.difference);
        out.push_str(&csv_field(&c.name));
        values.for_each(|v| out.push_str(&format!(",{}", number(*v))));
        out.push('\n');
    }
    out
}

fn as_json(args: &Args, colours: &[Colour], light: Option<&Light>) -> String {
    let one = |c: &Colour| {
        let mut object = serde_json::json!({
            "name": c.name, "xyz": c.xyz, "xy": c.xy, "rgb": c.rgb, "lab": [c.lab.l, c.lab.a, c.lab.b],
        });
        if let Some(d) = c.difference {
            object["delta_e_2000"] = d.into();
        }
        object
    };
    let mut report = serde_json::json!({
        "observer": format!("{}, 1 nm, 360-830 nm, plain summation", args.observer.name()),
        "k": k(args, light).map_or("Y = 100 for each".into(), serde_json::Value::from),
        "white_y": white_y(args),
        "colour_space": args.colour_space.name(),
        "lab_white": "D65",
        "colours": colours.iter().map(one).collect::<Vec<_>>(),
    });
    if let Some(light) = light {
        report["illuminant"] = light.name.clone().into();
    }
    format!("{report:#}\n")
}

fn matrices(args: &Args) -> String {
    let from = from_xyz(args);
    let to = if args.white.is_some() { invert(&from) } else { args.colour_space.to_xyz() };
    if args.json {
        let report = serde_json::json!({
            "colour_space": args.colour_space.name(),
            "chromaticities": args.colour_space.chromaticities(),
            "illuminants": ILLUMINANTS.iter().map(|(name, xy)| (name.to_string(), *xy)).collect::<BTreeMap<_, _>>(),
            "from_xyz": from,
            "to_xyz": to,
        });
        return format!("{report:#}\n");
    }
    let mut out = String::from("matrix,row,1,2,3\n");
    for (name, matrix) in [("from_xyz", from), ("to_xyz", to)] {
        for (k, row) in matrix.iter().enumerate() {
            out.push_str(&format!(
                "{name},{},{},{},{}\n",
                k + 1,
                number(row[0]),
                number(row[1]),
                number(row[2])
            ));
        }
    }
    out
}

fn spectra_csv(spectra: &[Named], light: Option<&Light>) -> String {
    let mut out = String::from("wavelength_nm");
    spectra.iter().for_each(|s| out.push_str(&format!(",{}", csv_field(&s.name))));
    let columns: Vec<Vec<f64>> = spectra.iter().map(|s| nanometres(s, light)).collect();
    for w in OBSERVER_RANGE.0..=OBSERVER_RANGE.1 {
        out.push_str(&format!("\n{w}"));
        columns.iter().for_each(|c| out.push_str(&format!(",{}", c[w - OBSERVER_RANGE.0])));
    }
    out.push('\n');
    out
}

/// A name as a CSV field, quoted where it must be.
fn csv_field(name: &str) -> String {
    if name.contains([',', '"', '\n']) {
        return format!("\"{}\"", name.replace('"', "\"\""));
    }
    name.to_string()
}
