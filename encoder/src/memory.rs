//! Memory that work may take, looked up before it is begun.

use std::fs::read_to_string;

use crate::error::{Error, Result};

/// Bytes of memory that this process can still have, as far as the system tells: what the machine has free, what the
/// control group allows, and what the limit on address space leaves.
#[must_use]
pub fn available() -> Option<u64> {
    [free(), group(), address_space()].into_iter().flatten().min()
}

/// Refuses work that needs more memory than there is; `what` names it.
///
/// # Errors
/// [`Error::Request`] with both numbers.
pub fn expect(need_bytes: u64, what: impl FnOnce() -> String) -> Result<()> {
    match available() {
        Some(free) if need_bytes > free => {
            let [need, free] = [need_bytes, free].map(gigabytes);
            Err(Error::Request(format!("{} takes {need} of memory, and there is {free}", what())))
        }
        _ => Ok(()),
    }
}

/// Bytes for people, in GB.
#[must_use]
pub(crate) fn gigabytes(bytes: u64) -> String {
    format!("{:.3} GB", bytes as f64 / 1e9)
}

fn free() -> Option<u64> {
    kibibytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// What a control group of version 2 allows beyond what it has; pages of files that it has can be dropped.
fn group() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let name = groups.lines().find_map(|line| line.strip_prefix("0::"))?.trim_start_matches('/');
    let folder = std::path::Path::new("/sys/fs/cgroup").join(name);
    let number = |file: &str| read_to_string(folder.join(file)).ok()?.trim().parse::<u64>().ok();
    let [limit, used] = [number("memory.max")?, number("memory.current")?];
    let files = read_to_string(folder.join("memory.stat"))
        .ok()
        .and_then(|stat| stat.lines().find_map(|line| line.strip_prefix("file "))?.parse::<u64>().ok());
    Some(limit.saturating_sub(used.saturating_sub(files.unwrap_or(0))))
}

/// What `ulimit -v` leaves.
fn address_space() -> Option<u64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = limit.split_whitespace().next()?.parse().ok()?;
    let used = kibibytes(&read_to_string("/proc/self/status").ok()?, "VmSize:")?;
    Some(limit.saturating_sub(used))
}

/// A field of a table of the system that is given in kB.
fn kibibytes(table: &str, field: &str) -> Option<u64> {
    let line = table.lines().find_map(|line| line.strip_prefix(field))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_much_is_refused_with_what_it_takes() {
        if available().is_none() {
            return;
        }
        assert!(expect(1, || "little".to_owned()).is_ok(), "a byte can be had");
        let error = expect(u64::MAX, || "all of it".to_owned()).unwrap_err().to_string();
        assert!(error.starts_with("all of it takes 18446744073.710 GB of memory, and there is"), "{error}");
    }
}
