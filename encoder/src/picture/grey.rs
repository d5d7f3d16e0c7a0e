//! Pictures of one float for each pixel: OpenEXR with luminance alone, and TIFF. Masks and heights often are.

use std::fs::File;
use std::io::BufReader;

use exr::block::reader::Reader;
use exr::image::read::read;
use exr::image::read::specific_channels::ReadSpecificChannel;
use exr::math::Vec2;
use exr::prelude::{IntegerBounds, ReadChannels, ReadLayers, Text};
use image::ImageFormat;
use image::metadata::Orientation;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

/// The channel of luminance in OpenEXR.
const LUMINANCE: &str = "Y";
/// Its channels of chroma beside luminance, in fewer pixels: such pictures are in colour.
const CHROMA: [&str; 2] = ["RY", "BY"];

/// A file whose header was read.
pub(super) enum Grey {
    Exr(Box<Reader<BufReader<File>>>, Window),
    Tiff(Box<Decoder<BufReader<File>>>, [u32; 2], Orientation),
}

/// The part of an OpenEXR file that is shown, and where its pixels begin in it.
#[derive(Clone, Copy)]
pub(super) struct Window {
    shown: IntegerBounds,
    start: Vec2<i32>,
}

impl Window {
    /// Which of the values that are shown a pixel of the file is, if any.
    fn index(self, pixel: Vec2<usize>) -> Option<usize> {
        let along = |pixel: usize, start: i32, first: i32, size: usize| {
            let at = i64::try_from(pixel).ok()? + i64::from(start) - i64::from(first);
            usize::try_from(at).ok().filter(|at| *at < size)
        };
        let Self { shown, start } = self;
        let x = along(pixel.x(), start.x(), shown.position.x(), shown.size.width())?;
        Some(along(pixel.y(), start.y(), shown.position.y(), shown.size.height())? * shown.size.width() + x)
    }
}

impl Grey {
    /// Such a picture of a format, if the file is one.
    pub(super) fn open(format: ImageFormat, file: BufReader<File>) -> Option<Self> {
        match format {
            ImageFormat::OpenExr => {
                let file = exr::block::read(file, false).ok()?;
                // Of several parts the first that can be shown is read.
                let header = file.headers().iter().find(|header| {
                    let has = |name: &str| header.channels.find_index_of_channel(&Text::from(name)).is_some();
                    !header.deep && has(LUMINANCE) && !CHROMA.into_iter().any(has)
                })?;
                let shown = header.shared_attributes.display_window;
                let window = Window { shown, start: header.own_attributes.layer_position };
                Some(Self::Exr(Box::new(file), window))
            }
            ImageFormat::Tiff => {
                let mut file = Decoder::new(file).ok()?;
                let (width, height) = file.dimensions().ok()?;
                let is_grey = matches!(file.colortype(), Ok(ColorType::Gray(32)));
                let told = file.find_tag_unsigned::<u8>(Tag::Orientation).ok().flatten();
                let orientation = told.and_then(Orientation::from_exif).unwrap_or(Orientation::NoTransforms);
                is_grey.then(|| Self::Tiff(Box::new(file), [width, height], orientation))
            }
            _ => None,
        }
    }

    /// Pixels in x and in y.
    pub(super) fn size(&self) -> [u32; 2] {
        match self {
            Self::Exr(_, window) => {
                [window.shown.size.width(), window.shown.size.height()].map(|side| u32::try_from(side).unwrap_or(0))
            }
            Self::Tiff(_, size, _) => *size,
        }
    }

    /// How to turn what is stored.
    pub(super) fn orientation(&self) -> Orientation {
        match self {
            Self::Exr(..) => Orientation::NoTransforms,
            Self::Tiff(_, _, orientation) => *orientation,
        }
    }

    /// All values, row by row; what was found where that is no such picture after all.
    pub(super) fn decode(self) -> Result<Vec<f32>, String> {
        match self {
            Self::Exr(file, window) => {
                let image = read()
                    .no_deep_data()
                    .largest_resolution_level()
                    .specific_channels()
                    .required::<f32>(LUMINANCE)
                    .collect_pixels(
                        move |_, _| vec![0.0; window.shown.size.area()],
                        move |values: &mut Vec<f32>, pixel, (value,): (f32,)| {
                            if let Some(at) = window.index(pixel) {
                                values[at] = value;
                            }
                        },
                    )
                    .first_valid_layer()
                    .all_attributes()
                    .from_chunks(*file)
                    .map_err(|error| error.to_string())?;
                Ok(image.layer_data.channel_data.pixels)
            }
            Self::Tiff(file, ..) => {
                // What the values take was checked.
                match file.with_limits(Limits::unlimited()).read_image() {
                    Ok(DecodingResult::F32(values)) => Ok(values),
                    Ok(_) => Err("no floats".to_owned()),
                    Err(error) => Err(error.to_string()),
                }
            }
        }
    }
}
