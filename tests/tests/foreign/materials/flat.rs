//! Materials that hardly vary, or are known from few sides: every method makes a file of them that shows them.

use glam::Vec3;
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::btf::{Goal, Method, Options, Size, encode};
use subsurf_encoder::capture::{Direction, Images, Merl, Source, bonn, load_btf};
use subsurf_encoder::metrics::btf::judge;
use subsurf_encoder::picture::PixelFormat;

use super::Warnings;

/// Value of a pixel by its number, the light and the view.
type Value = fn(u16, Vec3, Vec3) -> [f32; 3];

/// Images from a formula, of `side` × `side` pixels.
struct Formula {
    lights: Vec<Vec3>,
    views: Vec<Vec3>,
    side: u16,
    format: PixelFormat,
    value: Value,
}

impl Source for Formula {
    fn label(&self) -> String {
        "formula".to_owned()
    }

    fn lights(&self) -> Vec<Vec3> {
        self.lights.clone()
    }

    fn views(&self) -> Vec<Vec3> {
        self.views.clone()
    }

    fn size(&self) -> [u32; 2] {
        [self.side.into(); 2]
    }

    fn format(&self) -> PixelFormat {
        self.format
    }

    fn read(&self, light: usize, view: usize) -> subsurf_encoder::Result<Vec<[f32; 3]>> {
        let (light, view) = (self.lights[light], self.views[view]);
        Ok((0..self.side * self.side).map(|pixel| (self.value)(pixel, light, view)).collect())
    }
}

const METHODS: [Method; 3] = [Method::Nested, Method::Factored, Method::Havran2010];

/// PSNR of a small file in dB.
fn psnr(images: &[Images], method: Method, nodes: [u8; 4]) -> Result<f64, String> {
    let goal = match method {
        Method::Nested => Goal::Size(Size::Nested(Extent { p4: 8, stages: 2 })),
        _ => Goal::Usual,
    };
    let options = Options { method, nodes: Some(nodes), goal, ..Options::default() };
    let encoded =
        encode(images, &["flat".to_owned()], &options, &(), &mut |_| ()).map_err(|error| error.to_string())?;
    Ok(judge(images, &encoded.bytes, &()).expect("files of our own are read").psnr_db)
}

fn directions(count: usize) -> Vec<Vec3> {
    bonn().into_iter().take(count).map(Direction::unit).collect()
}

/// What varies in nothing, or in one thing only, comes back.
#[test]
fn materials_without_variation_are_encoded() {
    let materials: [(&str, Value); 9] = [
        ("black", |_, _, _| [0.0; 3]),
        ("white", |_, _, _| [1.0; 3]),
        ("grey", |_, _, _| [0.25; 3]),
        ("one colour", |_, _, _| [0.5, 0.25, 0.75]),
        ("Lambertian", |_, light, _| [0.5 * light.z; 3]),
        ("one hue", |_, light, _| [0.5 * light.z, 0.0, 0.0]),
        ("views alone", |_, _, view| [0.2 + 0.5 * view.z; 3]),
        ("grey texture", |pixel, light, _| [0.1 * f32::from(pixel % 7) * light.z; 3]),
        ("one pixel", |pixel, light, _| if pixel == 3 { [light.z, 0.5 * light.z, 0.0] } else { [0.0; 3] }),
    ];
    let all = directions(9);
    let both = |of| [(of, PixelFormat::Display8), (of, PixelFormat::Linear)];
    for ((name, value), format) in materials.into_iter().flat_map(both) {
        let formula = Formula { lights: all.clone(), views: all.clone(), side: 4, format, value };
        let images = [Images::load(&formula, &()).unwrap()];
        for method in METHODS {
            let found =
                psnr(&images, method, [5, 5, 3, 4]).unwrap_or_else(|error| panic!("{name}, {method:?}: {error}"));
            // The baseline's thresholds allow some errors.
            let least = if method == Method::Havran2010 { 15.0 } else { 25.0 };
            assert!(found > least, "{name}, {method:?}, {format}: {found:.1} dB");
        }
    }
}

/// Few directions are enough, two are the fewest; one image is refused before anything is computed.
#[test]
fn few_directions_are_encoded() {
    let (all, value): (Vec<Vec3>, Value) = (directions(31), |pixel, light, view| {
        let texture = 0.2 + 0.1 * f32::from(pixel % 5);
        [texture * light.z, 0.3 * view.z, 0.2]
    });
    for (lights, views) in [(31, 31), (9, 9), (9, 1), (1, 9), (2, 1), (1, 2), (1, 1)] {
        let formula = Formula {
            lights: all[..lights].to_vec(),
            views: all[all.len() - views..].to_vec(),
            side: 3,
            format: PixelFormat::Display8,
            value,
        };
        let images = [Images::load(&formula, &()).unwrap()];
        for method in METHODS {
            match psnr(&images, method, [5, 5, 3, 4]) {
                Ok(found) if lights * views > 1 => {
                    assert!(found > 15.0, "{lights} × {views}, {method:?}: {found:.1} dB")
                }
                Err(error) if lights * views == 1 => {
                    assert!(error.contains("formula: 1 image; a BTF has two"), "{error}")
                }
                other => panic!("{lights} × {views}, {method:?}: {other:?}"),
            }
        }
    }
}

/// Tables of MERL: of nothing, of what was not measured, and of paper.
#[test]
fn brdfs_without_variation_are_encoded() {
    let place = tempfile::tempdir().unwrap();
    for (name, value) in [("black", 0.0), ("unmeasured", -1.0), ("paper", 0.25)] {
        let path = place.path().join(name).with_extension("binary");
        Merl::write(&path, |_, _| [value; 3]).unwrap();
        let warnings = Warnings::default();
        let images = [load_btf(&path, &warnings).unwrap()];
        for method in METHODS {
            let found =
                psnr(&images, method, [9, 9, 3, 1]).unwrap_or_else(|error| panic!("{name}, {method:?}: {error}"));
            assert!(found > 20.0, "{name}, {method:?}: {found:.1} dB");
        }
        let warnings = warnings.into_lines();
        assert_eq!(warnings.len(), usize::from(value < 0.0), "{name}: {warnings:?}");
        assert!(warnings.iter().all(|line| line.contains("no sample was measured")), "{warnings:?}");
        std::fs::remove_file(path).unwrap();
    }
}
