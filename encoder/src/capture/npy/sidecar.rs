//! What a capture's array cannot say: `NAME.json` beside `NAME.npy`.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use subsurf_decoder::bssrdf::{Addressing, layout};

use crate::error::{Error, Result, one_line};

/// Refractive index where nobody says otherwise: that of most stones, waxes and plastics.
pub(crate) const DEFAULT_ETA: f32 = 1.5;

/// The facts a capture comes with.
#[derive(Clone, Debug, PartialEq)]
pub struct Sidecar {
    /// Distance of neighbouring pixels in mm, > 0.
    pub pitch_mm: f32,
    /// What lies beyond the border.
    pub addressing: Addressing,
    /// Refractive index, 1 to 4.
    pub eta: f32,
    /// Where a simulated capture comes from; `None` for measurements.
    pub simulated: Option<serde_json::Value>,
}

/// Facts that a caller states, whatever the sidecar says.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides {
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: Option<f32>,
    /// What lies beyond the border.
    pub addressing: Option<Addressing>,
    /// Refractive index.
    pub eta: Option<f32>,
}

/// The sidecar as it stands in the file, with these keys and perhaps others.
#[derive(Default, Deserialize, Serialize)]
struct Fields {
    pitch_mm: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    addressing: Option<AddressingName>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eta: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    simulated: Option<serde_json::Value>,
}

/// Keys of [`Fields`].
const KEYS: [&str; 4] = ["pitch_mm", "addressing", "eta", "simulated"];

#[derive(Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
enum AddressingName {
    Clamp,
    Repeat,
    Mirror,
}

impl From<AddressingName> for Addressing {
    fn from(name: AddressingName) -> Self {
        match name {
            AddressingName::Clamp => Self::Clamp,
            AddressingName::Repeat => Self::Repeat,
            AddressingName::Mirror => Self::Mirror,
        }
    }
}

impl From<Addressing> for AddressingName {
    fn from(addressing: Addressing) -> Self {
        match addressing {
            Addressing::Clamp => Self::Clamp,
            Addressing::Repeat => Self::Repeat,
            Addressing::Mirror => Self::Mirror,
        }
    }
}

const EXAMPLE: &str = r#"{"pitch_mm": 0.6}, and if need be "addressing" (clamp, repeat, mirror) and "eta""#;

/// `NAME.json` for `NAME.npy`.
#[must_use]
pub fn sidecar_path(capture: &Path) -> PathBuf {
    capture.with_extension("json")
}

/// Fields of a sidecar, and its keys that are not known.
fn parse(bytes: &[u8]) -> std::result::Result<(Fields, Vec<String>), String> {
    let text = decode(bytes)?;
    let fields = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let all: BTreeMap<String, IgnoredAny> = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let unknown = all.into_keys().filter(|key| !KEYS.contains(&key.as_str()));
    Ok((fields, unknown.map(|key| format!("{key:?}")).collect()))
}

/// Text in UTF-8 with or without a byte-order mark, or in UTF-16 with one.
fn decode(bytes: &[u8]) -> std::result::Result<String, String> {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let (pairs, rest) = bytes.as_chunks();
        let text = String::from_utf16(&pairs.iter().copied().map(unit).collect::<Vec<_>>());
        text.ok().filter(|_| rest.is_empty()).ok_or_else(|| "broken UTF-16".to_owned())
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] | rest => {
            let text = std::str::from_utf8(rest).map_err(|error| format!("not UTF-8: {error}"))?;
            Ok(text.to_owned())
        }
    }
}

/// Whether a file is the sidecar of a capture, and not something else in JSON.
pub(super) fn is_sidecar(bytes: &[u8]) -> bool {
    parse(bytes).is_ok_and(|(fields, _)| fields.pitch_mm.is_some())
}

impl Sidecar {
    /// Reads the sidecar of `capture`; `overrides` win, and a given pitch makes a sidecar unnecessary. Also returns a
    /// warning of keys that are not known.
    pub(super) fn load(capture: &Path, overrides: &Overrides) -> Result<(Self, Option<String>)> {
        let path = sidecar_path(capture);
        let (fields, unknown) = match std::fs::read(&path) {
            Ok(bytes) => {
                parse(&bytes).map_err(|error| Error::input(&path, format!("unreadable sidecar ({error})"), EXAMPLE))?
            }
            Err(error) if error.kind() == ErrorKind::NotFound => (Fields::default(), Vec::new()),
            Err(error) => return Err(Error::input(&path, error, EXAMPLE)),
        };
        let (count, names) = (unknown.len(), one_line(&unknown.join(", ")));
        let pitch_mm = overrides.pitch_mm.or(fields.pitch_mm).ok_or_else(|| {
            let has = if count > 0 { format!(", which has {names}") } else { String::new() };
            let found = format!("no pixel pitch: neither --pitch nor \"pitch_mm\" in {}{has}", path.display());
            Error::input(capture, found, EXAMPLE)
        })?;
        let unknown = (count > 0).then(|| {
            let (path, known) = (path.display(), KEYS.join(", "));
            format!("{path}: unknown keys are left out ({count}): {names}; known are {known}")
        });
        let sidecar = Self {
            pitch_mm,
            addressing: overrides.addressing.or(fields.addressing.map(Addressing::from)).unwrap_or_default(),
            eta: overrides.eta.or(fields.eta).unwrap_or(DEFAULT_ETA),
            simulated: fields.simulated,
        };
        sidecar.check(capture)?;
        Ok((sidecar, unknown))
    }

    /// Refuses values that a file could not hold.
    fn check(&self, capture: &Path) -> Result<()> {
        let [shortest, longest] = layout::LENGTHS_MM;
        if !(shortest..=longest).contains(&self.pitch_mm) {
            let found = format!("pixel pitch {} mm", self.pitch_mm);
            return Err(Error::input(capture, found, format!("a length from {shortest} to {longest} mm")));
        }
        if !(1.0..=layout::MAX_ETA).contains(&self.eta) {
            let found = format!("refractive index {}", self.eta);
            let expected = format!("1 to {}", layout::MAX_ETA);
            return Err(Error::input(capture, found, expected));
        }
        Ok(())
    }

    /// The text of the sidecar file.
    pub(super) fn to_json(&self) -> String {
        let fields = Fields {
            pitch_mm: Some(self.pitch_mm),
            addressing: Some(self.addressing.into()),
            eta: Some(self.eta),
            simulated: self.simulated.clone(),
        };
        format!("{:#}\n", serde_json::json!(fields))
    }
}
