//! The layout three-atmosphere. That its reader understands it is shown by that reader
//! (`scripts/validate-three-atmosphere`); here, what the tables hold.

use tyndall::internals::bake::{Product, bake};
use tyndall::internals::files::exr::from_exr_bytes;
use tyndall::internals::geometry::Point;
use tyndall::internals::geometry::view::View;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::layout::sky::{self, AerosolPhase, Component, Sky};
use tyndall::internals::layout::three_atmosphere::Bruneton;
use tyndall::internals::layout::three_atmosphere::{LAYOUT, ThreeAtmosphereLayout};
use tyndall::internals::preset::{self, Planet};
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

const FOLDER: &str = "in memory";

fn planet() -> Planet {
    preset::load("earth-paper", &["constituents.aerosol.density_factor=3".into()]).unwrap()
}

fn settings() -> Settings {
    let wavelengths_nm = vec![420.0, 480.0, 540.0, 600.0, 660.0];
    Settings { layouts: vec![&ThreeAtmosphereLayout], wavelengths_nm, ..Settings::default() }
}

fn open(product: &Product) -> Box<dyn Sky> {
    let tables = product.manifest.tables.iter();
    let pictures = tables.map(|t| {
        let bytes = &product.files.iter().find(|(name, _)| *name == t.file).unwrap().1;
        (t.name.clone(), from_exr_bytes(t.file.as_ref(), bytes).unwrap())
    });
    sky::of_pictures(FOLDER.as_ref(), &product.manifest, "three-atmosphere", &pictures.collect()).unwrap()
}

/// At texel centres nothing is interpolated: what is left of the difference to the solver's own integral, as RGB, is
/// rounding to halves (0.05 % of each of the two tables) and the fields that tables are filled from. Colours that leave
/// the gamut are stored as 0 and stay out of this.
#[test]
fn texel_centres_hold_the_solvers_light() {
    let (planet, settings) = (planet(), settings());
    let product = bake(&planet, &settings, &mut |_| {}).unwrap();
    let sky = open(&product);
    let medium = planet.medium(&settings.wavelengths_nm);
    let solution = Solution::new(&medium, &Resolution::TABLES, settings.orders);
    let map = Bruneton::new(medium.ground_radius, medium.top_radius, Bruneton::SIZE).unwrap();
    let matrix = &product.manifest.colour.matrices["rgb_from_all_wavelengths"];
    let lux = product.manifest.constants["star_illuminance_lx"][0];
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    let (mut errors, mut judged) = (Vec::new(), 0);
    for (i, j, k, l) in (3..32).step_by(7).flat_map(|i| {
        (2..128)
            .step_by(21)
            .flat_map(move |j| (10..32).step_by(5).flat_map(move |k| (0..8).map(move |l| (i, j, k, l))))
    }) {
        let altitude = map.shell().altitude(i);
        let ((mu, hits_ground), mu_s) = (map.mu(altitude, j), map.mu_s(k));
        let (nu, cos_azimuth) = Bruneton::possible(mu, mu_s, map.nu(l));
        if nu != map.nu(l) {
            continue; // Not a texel centre: the table's ν cannot be.
        }
        let view = View { r: map.shell().radii()[0] + altitude, mu, mu_s, nu, hits_ground };
        let light = solution.radiance(&view, &all).scattering;
        let truth: Vec<f64> =
            matrix.iter().map(|row| row.iter().zip(&light).map(|(m, v)| m * v).sum::<f64>() / lux).collect();
        let azimuth_deg = libm::acos(cos_azimuth).to_degrees();
        let point = Point { altitude, mu, mu_s, azimuth_deg };
        let found = sky.radiance(&point, Component::Scattering, AerosolPhase::Preset);
        judged += 1;
        let largest = truth.iter().fold(0.0f64, |a, &b| a.max(b));
        if truth.iter().all(|&v| v > 0.02 * largest) && largest > 1e-6 {
            errors.extend(found.iter().zip(&truth).map(|(f, t)| (f - t).abs() / largest));
        }
    }
    errors.sort_by(f64::total_cmp);
    assert!(judged > 300 && errors.len() > 600, "{judged} {}", errors.len());
    let (median, p95) = (errors[errors.len() / 2], errors[errors.len() * 95 / 100]);
    assert!(median < 1e-3 && p95 < 1e-2, "median {median:.2e}, 95 % below {p95:.2e}");
}

/// The package scales the light of the sky by a factor of its own parameters: with those of `parameters.json`, the
/// star's illuminance and a table's decoded value have one unit, so that both are the preset's in cd/m² and lx.
#[test]
fn parameters_and_tables_have_one_unit() {
    let wavelengths_nm = vec![450.0, 550.0, 650.0];
    let settings = Settings { wavelengths_nm, orders: Orders::First(1), ..settings() };
    let planet = planet();
    let product = bake(&planet, &settings, &mut |_| {}).unwrap();
    let file = &product.files.iter().find(|(name, _)| name == "three-atmosphere/parameters.json").unwrap().1;
    let parameters: serde_json::Value = serde_json::from_slice(file).unwrap();
    let rgb = |key: &str| ["x", "y", "z"].map(|c| parameters[key][c].as_f64().unwrap());
    let luminance = |v: [f64; 3]| 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
    // Relative luminance of the package: sky factor over the luminance of the sun's.
    let sky = rgb("skyRadianceToLuminance")[0] / luminance(rgb("sunRadianceToLuminance"));
    let table = product.manifest.tables.iter().find(|t| t.name == "scattering").unwrap();
    let unit = table.encoding.scale / sky;
    let star = luminance(rgb("solarIrradiance")) * unit;
    let lux = product.manifest.constants["star_illuminance_lx"][0];
    assert!((star / lux - 1.0).abs() < 1e-3, "{star} {lux}");
    assert_eq!(parameters["bottomRadius"], 6_371_000.0);
}

/// A grey air in a white light is as transparent in every colour as at every wavelength, and red, green and blue of its
/// transmittance straight up are e^−τ to a half's rounding.
#[test]
fn grey_transmittance_is_that_of_beer_and_lambert() {
    let sets =
        ["constituents.air.density_factor=1e-6".to_string(), "constituents.aerosol.density_factor=20".into()];
    let planet = preset::load("earth-paper", &sets).unwrap();
    let once = Settings { orders: Orders::First(1), ..settings() };
    let product = bake(&planet, &once, &mut |_| {}).unwrap();
    let table = product.manifest.tables.iter().find(|t| t.name == "transmittance").unwrap();
    let bytes = &product.files.iter().find(|(name, _)| *name == table.file).unwrap().1;
    let atlas = from_exr_bytes(table.file.as_ref(), bytes).unwrap();
    let depth = planet.medium(&[550.0]).vertical_optical_depth()[0];
    for channel in ["R", "G", "B"] {
        let found = f64::from(atlas.channel(channel).unwrap().samples.get(0));
        assert!((found / libm::exp(-depth) - 1.0).abs() < 1e-3, "{channel} {found} {depth}");
    }
}

/// `diff` looks at the views of this layout as at those of every other: of two bakes under ground of another brightness
/// their light differs, and of one with itself it does not.
#[test]
fn diff_compares_views() {
    let settings =
        Settings { wavelengths_nm: vec![450.0, 550.0, 650.0], orders: Orders::First(1), ..settings() };
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, albedo: &str| {
        let planet = preset::load("earth-paper", &[format!("ground.albedo={albedo}")]).unwrap();
        let folder = dir.path().join(name);
        for (file, bytes) in bake(&planet, &settings, &mut |_| {}).unwrap().files {
            std::fs::create_dir_all(folder.join(&file).parent().unwrap()).unwrap();
            std::fs::write(folder.join(&file), bytes).unwrap();
        }
        folder
    };
    let (a, b) = (write("a", "0.1"), write("b", "0.8"));
    let compare = |a: &std::path::Path, b: &std::path::Path| {
        tyndall::internals::commands::diff::compare(a, b, 20).unwrap()
    };
    let same = compare(&a, &a);
    assert!(same.nothing() && same.views.iter().any(|v| v.layout == LAYOUT));
    let differ = compare(&a, &b);
    let largest = differ.views.iter().map(|v| v.radiance.max).fold(0.0, f64::max);
    assert!(largest > 0.5, "{largest}");
}
