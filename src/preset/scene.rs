//! What of a planet a program shows, and how well: what the planner works from.

/// A scene, validated.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub name: String,
    pub description: String,
    /// Name of a shipped planet, or a path.
    pub planet: String,
    /// Lowest and highest altitude of observers, m; above the air they look in from outside.
    pub altitudes: [f64; 2],
    /// Lowest and highest elevation of the sun over the observer's horizontal, degrees.
    pub suns: [f64; 2],
    /// Whether views under a sun below the horizontal have to be as exact as the others.
    pub twilight_matters: bool,
    /// Elevations of the view, degrees; from 0 on the ground is never seen.
    pub elevations: [f64; 2],
    /// Azimuths between view and sun, degrees.
    pub azimuths: [f64; 2],
    /// Whether light has to differ between azimuths as it does; if not, its mean over them is what counts.
    pub azimuth_matters: bool,
    pub waters: Vec<SceneWater>,
    pub tolerance: Tolerance,
    pub budget: Budget,
}

/// A water of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneWater {
    /// Name of a shipped water, or a path.
    pub water: String,
    /// Least and largest depth, m.
    pub depths: [f64; 2],
}

/// The error that a share of the views may have at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    pub metric: Metric,
    pub most: f64,
    /// Share of the views, 0..1, that must meet it.
    pub share: f64,
}

/// How an error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Length of the difference of two linear RGB colours over that of the true one.
    Relative,
    /// ΔE2000, both exposed so that the true one has Y = 0.18.
    DeltaE,
}

/// What a model may cost at most; none: any amount.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// Bytes of texels, as a GPU holds them.
    pub bytes: Option<f64>,
    /// Processor seconds of a bake, without its report and pictures.
    pub bake_s: Option<f64>,
    /// Texture fetches of a view that ends on the ground.
    pub fetches: Option<f64>,
}

impl Tolerance {
    /// An error in the metric's words.
    pub fn text(&self, error: f64) -> String {
        match self.metric {
            Metric::Relative => format!("{} %", short(100.0 * error)),
            Metric::DeltaE => format!("{} ΔE2000", short(error)),
        }
    }
}

/// Two significant digits, or the whole number.
fn short(v: f64) -> String {
    match v.abs() {
        a if a >= 9.95 => format!("{v:.0}"),
        a if a >= 0.995 => format!("{v:.1}"),
        a if a >= 0.0995 => format!("{v:.2}"),
        _ => format!("{v:.3}"),
    }
}

impl Scene {
    /// All heights, by day, both halves of the view: what `bake --tolerance` plans for.
    pub fn default_of(planet: &str, height: f64, tolerance: Tolerance) -> Scene {
        Scene {
            name: "default".into(),
            description: "observers on the ground, in the air and outside, by day".into(),
            planet: planet.into(),
            altitudes: [0.0, 2.0 * height],
            suns: [0.0, 90.0],
            twilight_matters: true,
            elevations: [-90.0, 90.0],
            azimuths: [0.0, 180.0],
            azimuth_matters: true,
            waters: Vec::new(),
            tolerance,
            budget: Budget::default(),
        }
    }
}
