//! EXR files: same bytes always, same values back, and nothing but one line for a damaged one.

use half::f16;
use proptest::prelude::*;
use std::path::Path;
use tyndall::internals::files::exr::{
    Spectral, from_exr_bytes, spectral_attributes, spectral_channel, to_exr_bytes,
};
use tyndall::internals::files::{Atlas, Attribute, Samples};

const FILE: &str = "t.exr";

/// Every finite half, twice over, in 5 × 8 slices of a ragged grid: subnormals, both zeros and the largest.
fn every_half() -> Atlas {
    let shape = [31, 67, 40];
    let finite: Vec<u16> = (0..=u16::MAX).filter(|&b| f16::from_bits(b).is_finite()).collect();
    let channel = |step: usize| {
        let bits = (0..shape.iter().product()).map(|k: usize| finite[k * step % finite.len()]);
        Samples::Half(bits.map(f16::from_bits).collect())
    };
    let mut atlas = Atlas::new(FILE, shape).with("R", channel(1)).with("G", channel(7));
    atlas = atlas.with("B", channel(11)).with("A", channel(13));
    for (name, value) in [
        ("mapping", Attribute::Text("u = r / R, größer".into())),
        ("orders", Attribute::Int(-3)),
        ("scale", Attribute::Float(0.1)),
        ("an_attribute_whose_name_is_longer_than_31_bytes", Attribute::Text(String::new())),
    ] {
        atlas.attributes.insert(name.into(), value);
    }
    atlas
}

/// A smooth table of both precisions, as the layouts have.
fn small() -> Atlas {
    let shape = [5, 4, 3];
    let wave = |k: usize| libm::sin(k as f64 * 0.1);
    Atlas::new(FILE, shape)
        .with("T.550,000000nm", Samples::float((0..60).map(wave)))
        .with("S0.440,000000nm", Samples::half((0..60).map(wave)))
}

fn bits(samples: &Samples) -> Vec<u32> {
    match samples {
        Samples::Half(v) => v.iter().map(|x| u32::from(x.to_bits())).collect(),
        Samples::Float(v) => v.iter().map(|x| x.to_bits()).collect(),
    }
}

/// Every bit of every sample returns, and so do sizes, order of slices and attributes.
#[test]
fn an_atlas_comes_back_as_it_went_in() {
    for atlas in [every_half(), small()] {
        let back = from_exr_bytes(Path::new(FILE), &to_exr_bytes(&atlas).unwrap()).unwrap();
        assert_eq!((back.width, back.height, back.slices), (atlas.width, atlas.height, atlas.slices));
        assert_eq!((back.columns, &back.attributes), (atlas.columns, &atlas.attributes));
        assert_eq!(back.channels.len(), atlas.channels.len());
        for (got, sent) in back.channels.iter().zip(atlas.sorted_channels()) {
            assert_eq!(got.name, sent.name);
            assert!(bits(&got.samples) == bits(&sent.samples), "{}", got.name);
        }
    }
}

/// Who reads the whole picture finds each sample at the place that the packing promises: slice s in column
/// s mod columns, row s / columns, slice 0 top left, and zeros in places left over.
#[test]
fn a_reader_of_the_picture_finds_each_sample_at_its_promised_place() {
    use exr::prelude::*;
    for atlas in [every_half(), small()] {
        let bytes = to_exr_bytes(&atlas).unwrap();
        let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = image.all_attributes().from_buffered(std::io::Cursor::new(bytes)).unwrap();
        let layer = &image.layer_data;
        assert_eq!(layer.encoding.compression, Compression::ZIP16);
        let picture = [atlas.width * atlas.columns, atlas.height * atlas.rows()];
        assert_eq!([layer.size.0, layer.size.1], picture);
        for (found, sent) in layer.channel_data.list.iter().zip(atlas.sorted_channels()) {
            assert_eq!(found.name.to_string(), sent.name);
            let values: Vec<f32> = found.sample_data.values_as_f32().collect();
            for (at, &value) in values.iter().enumerate() {
                let (px, py) = (at % picture[0], at / picture[0]);
                let slice = py / atlas.height * atlas.columns + px / atlas.width;
                let index = (slice * atlas.height + py % atlas.height) * atlas.width + px % atlas.width;
                let expected = if slice < atlas.slices { sent.samples.get(index) } else { 0.0 };
                assert_eq!(value.to_bits(), expected.to_bits(), "{} at {px}, {py}", sent.name);
            }
        }
    }
}

/// A strip from the bottom: the file's last line is the first of slice 0, its first line the last of the last slice,
/// as readers want that turn pictures round. It comes back as it went in.
#[test]
fn a_strip_from_the_bottom_is_upside_down_in_the_file_only() {
    use exr::prelude::*;
    let values = || (0..24).map(|k| k as f64);
    let atlas = Atlas::new(FILE, [2, 3, 4]).in_a_strip_from_the_bottom().with("R", Samples::half(values()));
    let bytes = to_exr_bytes(&atlas).unwrap();
    let back = from_exr_bytes(Path::new(FILE), &bytes).unwrap();
    assert_eq!(
        (back.origin, bits(&back.channels[0].samples)),
        (atlas.origin, bits(&Samples::half(values())))
    );
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = image.all_attributes().from_buffered(std::io::Cursor::new(bytes)).unwrap();
    let found: Vec<f32> = image.layer_data.channel_data.list[0].sample_data.values_as_f32().collect();
    assert_eq!(image.layer_data.size, Vec2(2, 12));
    assert_eq!((&found[..4], &found[22..]), (&[22.0, 23.0, 20.0, 21.0][..], &[0.0, 1.0][..]));
}

/// Same input, same bytes: over runs and thread counts.
#[test]
fn bytes_do_not_depend_on_run_or_threads() {
    let atlas = every_half();
    let first = to_exr_bytes(&atlas).unwrap();
    for threads in [1, 2, 5, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert!(pool.install(|| to_exr_bytes(&every_half())).unwrap() == first, "{threads} threads");
    }
}

/// The bytes themselves are fixed: a new version of the compressor that changed them would change every bake
/// of the same input, and has to be a decision. The hash is of this test's own first output.
#[test]
fn bytes_are_those_of_earlier_versions() {
    let hash = blake3::hash(&to_exr_bytes(&small()).unwrap()).to_hex().to_string();
    assert_eq!(hash, "7a27014865588023c52eb7b97130882845ad8f7827da277d681bcc85eff56f4d");
}

/// Spectral channels are listed alphabetically, which is by wavelength as long as all have three digits.
#[test]
fn spectral_channels_come_back_by_wavelength() {
    let mut atlas = Atlas::new(FILE, [2, 2, 1]);
    for nm in [700.0, 380.0, 550.5] {
        atlas = atlas.with(spectral_channel(Spectral::Radiance, nm), Samples::float([nm; 4]));
    }
    atlas.attributes = spectral_attributes();
    let back = from_exr_bytes(Path::new(FILE), &to_exr_bytes(&atlas).unwrap()).unwrap();
    let names: Vec<&str> = back.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["S0.380,000000nm", "S0.550,500000nm", "S0.700,000000nm"]);
    assert_eq!(back.channels.iter().map(|c| c.samples.get(0)).collect::<Vec<_>>(), [380.0, 550.5, 700.0]);
    assert_eq!(back.attributes["emissiveUnits"], Attribute::Text("W.m^-2.sr^-1".into()));
}

/// The refusal names table, channel and texel, so that the solver's fault can be found.
#[test]
fn what_is_not_finite_is_refused_with_its_place() {
    let mut values = [0.5; 60];
    values[2 * 20 + 3 * 5 + 4] = f64::NAN;
    let error =
        to_exr_bytes(&Atlas::new("scattering", [5, 4, 3]).with("R", Samples::half(values))).unwrap_err();
    assert_eq!(error.exit_code(), 3);
    assert!(error.to_string().contains("scattering"), "{error}");
    assert!(error.to_string().contains("channel R, x 4, y 3, slice 2"), "{error}");
}

/// Sizes and names that a file cannot hold are the caller's mistake, not a panic.
#[test]
fn atlases_that_no_file_can_hold_are_refused() {
    let ok = || Samples::half([1.0; 8]);
    let mut wide = Atlas::new(FILE, [2, 2, 2]).with("R", ok());
    wide.columns = 3;
    let none = Atlas::new(FILE, [2, 2, 2]);
    let twice = Atlas::new(FILE, [2, 2, 2]).with("R", ok()).with("R", ok());
    let short = Atlas::new(FILE, [2, 2, 3]).with("R", ok());
    let unnamed = Atlas::new(FILE, [2, 2, 2]).with("", ok());
    let flat = Atlas::new(FILE, [0, 2, 2]).with("R", ok());
    for atlas in [wide, none, twice, short, unnamed, flat] {
        assert_eq!(to_exr_bytes(&atlas).unwrap_err().exit_code(), 2);
    }
}

/// Whatever becomes of the bytes, the answer is an atlas or one line that names the file.
fn is_an_atlas_or_one_line(bytes: &[u8]) -> bool {
    match from_exr_bytes(Path::new(FILE), bytes) {
        Ok(_) => true,
        Err(e) => {
            let text = e.to_string();
            assert!(text.starts_with(FILE) && !text.contains('\n') && e.exit_code() == 2, "{text}");
            false
        }
    }
}

/// A file cut anywhere has lost a tile or part of its header: never an atlas.
#[test]
fn a_truncated_file_is_refused_at_every_length() {
    let bytes = to_exr_bytes(&small()).unwrap();
    assert!(is_an_atlas_or_one_line(&bytes));
    for length in 0..bytes.len() {
        assert!(!is_an_atlas_or_one_line(&bytes[..length]), "{length} of {} bytes", bytes.len());
    }
}

/// `bytes` with other numbers in the header attribute `name` of type `kind`.
fn with_attribute(mut bytes: Vec<u8>, name: &str, kind: &str, numbers: &[i32]) -> Vec<u8> {
    let value: Vec<u8> = numbers.iter().flat_map(|v| v.to_le_bytes()).collect();
    let name = format!("{name}\0{kind}\0");
    let at = bytes.windows(name.len()).position(|w| w == name.as_bytes()).unwrap();
    // The size takes four bytes.
    let start = at + name.len() + 4;
    bytes[start..start + value.len()].copy_from_slice(&value);
    bytes
}

/// Headers that agree with themselves and tell of terabytes, in a file of a few hundred bytes: one huge tile,
/// and a great many small ones. Refused by their size, not by what the allocator says.
#[test]
fn an_oversized_picture_is_refused_before_it_is_made() {
    let (huge, many) = (1 << 29, 1 << 24);
    let sizes = |tile: i32, columns: i32, rows: i32| {
        let picture = [0, 0, tile * columns - 1, tile * rows - 1];
        let mut bytes =
            to_exr_bytes(&Atlas::new(FILE, [2, 2, 4]).with("R", Samples::half([0.5; 16]))).unwrap();
        for (name, value) in
            [("columns", columns), ("rows", rows), ("sliceWidth", tile), ("sliceHeight", tile)]
        {
            bytes = with_attribute(bytes, name, "int", &[value]);
        }
        bytes = with_attribute(bytes, "slices", "int", &[columns.saturating_mul(rows)]);
        bytes = with_attribute(bytes, "dataWindow", "box2i", &picture);
        with_attribute(bytes, "tiles", "tiledesc", &[tile, tile])
    };
    assert!(from_exr_bytes(Path::new(FILE), &sizes(2, 2, 2)).is_ok());
    for bytes in [sizes(huge, 1, 1), sizes(2, many, 2), sizes(1, 64, 64)] {
        let error = from_exr_bytes(Path::new(FILE), &bytes).unwrap_err().to_string();
        assert!(error.contains("cannot be in a file of"), "{error}");
    }
    // In a file that is long enough, since zeros deflate a thousandfold: 80 GB that no memory here has room for.
    let mut bomb = sizes(200_000, 1, 1);
    bomb.resize(78_000_000, 0);
    let error = from_exr_bytes(Path::new(FILE), &bomb).unwrap_err().to_string();
    let roomy = tyndall::internals::machine::memory::available().is_none_or(|free| free > 400_000_000_000);
    assert!(roomy || error.contains("takes some 400.0 GB of memory, and "), "{error}");
}

/// OpenEXR gives some attributes a meaning of their own; a caller's of that name would be another one.
#[test]
fn an_attribute_with_a_name_of_openexrs_own_is_refused() {
    for name in ["channels", "compression", "owner"] {
        let mut atlas = small();
        atlas.attributes.insert(name.into(), Attribute::Int(1));
        let error = to_exr_bytes(&atlas).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(name), "{error}");
    }
}

/// Files of other kinds say why they are not read: a striped EXR, an uncompressed one, a PNG, nothing.
#[test]
fn foreign_files_are_refused_with_the_reason() {
    use exr::prelude::*;
    let encode = |encoding: Encoding| {
        let channels = SpecificChannels::rgba(|p: Vec2<usize>| (p.x() as f32, 0.5f32, 0.5f32, 1.0f32));
        let mut bytes = std::io::Cursor::new(Vec::new());
        let layer = Layer::new((8, 8), LayerAttributes::named("x"), encoding, channels);
        Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    };
    let striped = encode(Encoding::UNCOMPRESSED);
    let tiled = encode(Encoding { blocks: Blocks::Tiles(Vec2(8, 8)), ..Encoding::UNCOMPRESSED });
    for (bytes, reason) in [
        (striped, "single part in tiles"),
        (tiled, "sliceWidth"),
        (b"\x89PNG\r\n\x1a\n and more".to_vec(), "not an EXR file"),
        (Vec::new(), "not an EXR file"),
    ] {
        let error = from_exr_bytes(Path::new(FILE), &bytes).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}

/// A name in a damaged header may hold a line break; the message holds none.
#[test]
fn a_name_with_a_line_break_stays_on_one_line() {
    let mut bytes = to_exr_bytes(&small()).unwrap();
    let name = b"T.550,000000nm\0\x02";
    let at = bytes.windows(name.len()).position(|w| w == name).unwrap();
    bytes[at + 1] = b'\n';
    bytes[at + name.len() - 1] = 0;
    assert!(!is_an_atlas_or_one_line(&bytes));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    /// Flipped bits anywhere, also several: no panic, no absurd allocation, and no name from the damaged
    /// header that would break the line of the message.
    #[test]
    fn damaged_bytes_never_panic(flips in proptest::collection::vec((any::<prop::sample::Index>(), 1u8..), 1..4)) {
        let mut bytes = to_exr_bytes(&small()).unwrap();
        for (place, flip) in flips {
            let at = place.index(bytes.len());
            bytes[at] ^= flip;
        }
        is_an_atlas_or_one_line(&bytes);
    }
}
