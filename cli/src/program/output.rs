//! Standard output, which its reader may close at any time.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write};

/// `println!` that ends the program quietly once nobody reads, as programs in a pipe do.
macro_rules! say {
    ($($arg:tt)*) => {
        $crate::say::line(format_args!($($arg)*))
    };
}
pub(crate) use say;

pub(crate) fn line(text: Arguments<'_>) {
    let mut out = std::io::stdout().lock();
    let written = out.write_fmt(text).and_then(|()| out.write_all(b"\n"));
    if let Err(error) = written {
        subsurf_encoder::remove_unfinished();
        if error.kind() != ErrorKind::BrokenPipe {
            eprintln!("subsurf: cannot write to standard output: {error}");
        }
        std::process::exit(1);
    }
}
