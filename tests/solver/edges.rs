//! A cloud with edges in tables of few altitudes.

use tyndall::bake::bake;
use tyndall::bake::compact::Sizes;
use tyndall::bake::settings::{Layout, Settings};
use tyndall::export::exr::from_exr_bytes;
use tyndall::medium::DensityProfile;
use tyndall::points::Point;
use tyndall::preset;
use tyndall::quality::Distribution;
use tyndall::sky::{AerosolPhase, Component, Sky};
use tyndall::transport::solve::{Orders, Resolution, Solution};
use tyndall::transport::view::View;

/// A cloud from 20 to 30 km, thin enough for the sun to be seen through, in the air of `earth-paper`, in tables of nine
/// altitudes: inside it, 23 to 28 km high, rays upwards cross cloud, those of the next altitude do not. Were the table
/// of the cloud's light dark there, logarithms half-way would be those of a millionth, and with the cloud some half of the
/// light would be lost. Truth: the same solver, integrated directly along the ray.
#[test]
fn light_of_a_cloud_is_there_below_its_edge() {
    let mut planet = preset::load("earth-paper", &[]).unwrap();
    planet.constituents[1].profile = DensityProfile::Layer { bottom: 20e3, top: 30e3 };
    let settings = Settings {
        layouts: vec![Layout::Compact],
        compact: Sizes { single: [9, 20, 12, 4], multiple: [9, 20, 12, 4], ..Sizes::default() }.into(),
        wavelengths_nm: vec![450.0, 550.0, 650.0, 700.0],
        ..Settings::default()
    };
    let product = bake(&planet, &settings, &mut |_| {}).unwrap();
    let tables = product.manifest.tables.iter().filter(|t| t.layout == "compact");
    let open = |name: &str| &product.files.iter().find(|f| f.0 == name).unwrap().1;
    let pictures = tables
        .map(|t| (t.name.clone(), from_exr_bytes(std::path::Path::new("edges"), open(&t.file)).unwrap()))
        .collect();
    let sky = Sky::new(std::path::Path::new("edges"), &product.manifest, "compact", &pictures).unwrap();
    let tyndall::sky::Channels::Wavelengths(nm) = sky.channels() else { panic!("wavelengths") };
    let medium = planet.medium(&nm);
    let truth = Solution::new(&medium, &Resolution::TABLES, Orders::Converged { tolerance: 1e-3 });
    let mut errors = Vec::new();
    for altitude in [23e3, 25e3, 26e3, 27e3, 28e3] {
        for mu in [0.2, 0.5, 0.9] {
            for mu_s in [0.3, 0.8] {
                let point = Point { altitude, mu, mu_s, azimuth_deg: 70.0 };
                let view = View::enter(&point, medium.ground_radius, medium.top_radius).unwrap();
                let wanted = truth.radiance(&view, &[0, 1]).scattering;
                let found = sky.radiance(&point, Component::Scattering, AerosolPhase::Preset);
                errors.extend(found.iter().zip(&wanted).map(|(f, w)| (f / w - 1.0).abs()));
            }
        }
    }
    let errors = Distribution::of(errors);
    println!("{errors:?}");
    assert!(errors.p95 < 0.2, "{errors:?}");
}
