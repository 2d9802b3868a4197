//! A cloud with edges in tables of few altitudes.

use std::path::Path;
use tyndall::internals::bake::bake;
use tyndall::internals::files::exr::from_exr_bytes;
use tyndall::internals::geometry::Point;
use tyndall::internals::geometry::view::View;
use tyndall::internals::layout::compact::CompactLayout;
use tyndall::internals::layout::compact::Sizes;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::layout::sky::{self, AerosolPhase, Channels, Component, Sky};
use tyndall::internals::medium::DensityProfile;
use tyndall::internals::preset::{self, Planet};
use tyndall::internals::quality::Distribution;
use tyndall::internals::spectrum::grid;
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

/// A cloud from 20 to 30 km, thin enough for the sun to be seen through, in the air of `earth-paper`, in tables whose
/// altitudes lie at 19, 26 and 35 km there. From 27 to 29 km rays upwards cross cloud, those of the next altitude do not;
/// from space, rays that pass 22 to 28 km high cross it, those a view texel higher do not. Were the table of the cloud's
/// light dark there, logarithms half-way would be those of a millionth and the cloud's light would be lost: bridged, less
/// than half as much is, and most of that just below the edge, where the light falls to nothing and its logarithm evenly. Below, 21 to 25 km high, no texel is dark, and over the cloud there is none of its light but in
/// the rest of its last step. Truth: the same solver, integrated directly along the ray.
#[test]
fn light_of_a_cloud_is_there_up_to_its_edge() {
    let mut planet = preset::load("earth-paper", &[]).unwrap();
    planet.constituents[1].profile = DensityProfile::Layer { bottom: 20e3, top: 30e3 };
    // Two batches of wavelengths.
    let (sky, nm) = small_tables(&planet, 18);
    let medium = planet.medium(&nm);
    let truth = Solution::new(&medium, &Resolution::TABLES, Orders::Converged { tolerance: 1e-3 });
    // Errors, and the cloud's share of the light.
    let compare = |altitudes: &[f64], cosines: &dyn Fn(f64) -> Vec<f64>| {
        let (mut errors, mut shares) = (Vec::new(), Vec::new());
        for &altitude in altitudes {
            for mu in cosines(planet.ground_radius + altitude) {
                for mu_s in [0.3, 0.8] {
                    let point = Point { altitude, mu, mu_s, azimuth_deg: 70.0 };
                    let view = View::enter(&point, medium.ground_radius, medium.top_radius).unwrap();
                    let wanted = truth.radiance(&view, &[0, 1]).scattering;
                    let cloud = truth.radiance(&view, &[1]).scattering;
                    let found = sky.radiance(&point, Component::Scattering, AerosolPhase::Preset);
                    errors.extend(found.iter().zip(&wanted).map(|(f, w)| (f / w - 1.0).abs()));
                    shares.extend(cloud.iter().zip(&wanted).map(|(c, w)| c / w));
                }
            }
        }
        (Distribution::of(errors), Distribution::of(shares))
    };
    let upwards = |_: f64| vec![0.2, 0.5, 0.9];
    let past = |r: f64| {
        let tangent = |height: f64| -libm::cos(libm::asin((planet.ground_radius + height) / r));
        [22e3, 24e3, 26e3, 28e3].map(tangent).to_vec()
    };
    for (place, altitudes, cosines, median, p95) in [
        ("inside", &[21e3, 23e3, 25e3][..], &upwards as &dyn Fn(f64) -> Vec<f64>, 0.05, 0.1),
        ("below the edge", &[27e3, 28e3, 29e3], &upwards, 0.3, 0.75),
        ("over", &[36e3, 45e3], &upwards, 0.03, 0.2),
        ("from space", &[300e3], &past, 0.1, 0.3),
    ] {
        let (errors, shares) = compare(altitudes, cosines);
        println!("{place}: {errors:?}, of the cloud {shares:?}");
        assert!(errors.median < median && errors.p95 < p95, "{place}: {errors:?}");
        assert!(place == "over" || errors.median < 0.5 * shares.median, "{place}: {errors:?} {shares:?}");
    }
}

/// The sky of a bake of few altitudes, and the wavelengths that it answers at.
fn small_tables(planet: &Planet, wavelengths: usize) -> (Box<dyn Sky>, Vec<f64>) {
    let settings = Settings {
        layouts: vec![&CompactLayout],
        compact: Sizes { single: [17, 20, 12, 4], multiple: [17, 20, 12, 4], ..Sizes::default() }.into(),
        wavelengths_nm: grid(wavelengths),
        ..Settings::default()
    };
    let product = bake(planet, &settings, &mut |_| {}).unwrap();
    let place = Path::new("a bake in memory");
    let open = |name: &str| &product.files.iter().find(|f| f.0 == name).unwrap().1;
    let tables = product.manifest.tables.iter().filter(|t| t.layout == "compact");
    let pictures = tables.map(|t| (t.name.clone(), from_exr_bytes(place, open(&t.file)).unwrap())).collect();
    let sky = sky::of_pictures(place, &product.manifest, "compact", &pictures).unwrap();
    let Channels::Wavelengths(nm) = sky.channels() else { panic!("compact holds wavelengths") };
    (sky, nm)
}
