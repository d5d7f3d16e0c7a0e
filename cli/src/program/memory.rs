//! Memory of this process.

/// Resident memory in bytes, as far as the system tells.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resident {
    /// Largest resident memory so far.
    pub peak: u64,
    /// Of what is resident now, pages of mapped files.
    pub mapped: u64,
}

/// Reads `/proc/self/status`; `None` where there is none.
pub fn resident() -> Option<Resident> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let field = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name))?;
        let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kib * 1024)
    };
    Some(Resident { peak: field("VmHWM:")?, mapped: field("RssFile:").unwrap_or(0) })
}
