//! Threads that work runs on.

use std::thread::available_parallelism;

use super::failure::bad_request;

/// Threads for each core, at most: more only take memory.
const OF_CORE: usize = 8;
/// Where the number stands if no option tells it.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// Makes all work run on so many threads.
///
/// # Errors
/// None, or more of them than cores are worth.
pub fn set(threads: Option<usize>) -> anyhow::Result<()> {
    let Some(threads) = threads else {
        return Ok(());
    };
    check("--threads", threads)?;
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?)
}

/// Refuses a number of threads in the environment that is out of range.
pub(super) fn check_environment() -> anyhow::Result<()> {
    // 0 and what is no number stand for the usual number.
    match std::env::var(VARIABLE).ok().and_then(|threads| threads.parse().ok()) {
        None | Some(0) => Ok(()),
        Some(threads) => check(VARIABLE, threads),
    }
}

fn check(name: &str, threads: usize) -> anyhow::Result<()> {
    let cores = available_parallelism().map_or(1, usize::from);
    match threads {
        0 => Err(bad_request(format!("{name} is 0; leave it out to use all of them"))),
        threads if threads > OF_CORE * cores => Err(bad_request(format!(
            "{name} is {threads}; this machine has {cores} cores, and up to {} threads make sense",
            OF_CORE * cores
        ))),
        _ => Ok(()),
    }
}
