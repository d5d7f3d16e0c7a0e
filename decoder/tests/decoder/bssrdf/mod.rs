//! Files of BSSRDFs.

mod basis;
mod cascade;
mod format;
mod hostile;
mod limits;
#[cfg(feature = "push")]
mod profile_table;
mod values;
