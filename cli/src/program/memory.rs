//! What this process holds of the machine's memory.

/// Resident memory in bytes, as far as the system tells.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Resident {
    /// The most there has been so far.
    pub(crate) peak: u64,
    /// Of what is resident now, pages of mapped files.
    pub(crate) mapped: u64,
}

/// Reads `/proc/self/status`; `None` where there is none.
pub(crate) fn resident() -> Option<Resident> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let field = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name))?;
        let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kib * 1024)
    };
    Some(Resident { peak: field("VmHWM:")?, mapped: field("RssFile:").unwrap_or(0) })
}

/// Bytes that can still be had, as far as the system tells.
pub(crate) fn available() -> Option<u64> {
    let memory = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = memory.lines().find(|line| line.starts_with("MemAvailable:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib * 1024)
}

/// Bytes for people: three digits and a unit.
pub(crate) fn human(bytes: u64) -> String {
    #[allow(clippy::cast_precision_loss, reason = "three digits are shown")]
    let mut value = bytes as f64;
    let mut unit = "B";
    for larger in ["kB", "MB", "GB"] {
        if value < 1000.0 {
            break;
        }
        value /= 1000.0;
        unit = larger;
    }
    match unit {
        "B" => format!("{bytes} B"),
        _ if value < 10.0 => format!("{value:.2} {unit}"),
        _ if value < 100.0 => format!("{value:.1} {unit}"),
        _ => format!("{value:.0} {unit}"),
    }
}
