//! Standard output, which its reader may close at any time.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write};

/// `println!` that ends the program quietly once nobody reads, as programs in a pipe do.
#[macro_export]
macro_rules! outln {
    ($($arg:tt)*) => {
        $crate::program::output::line(format_args!($($arg)*))
    };
}

/// Writes a line to standard output; ends the program where that cannot be done. For [`outln!`](crate::outln).
pub fn line(text: Arguments<'_>) {
    let mut out = std::io::stdout().lock();
    let written = out.write_fmt(text).and_then(|()| out.write_all(b"\n"));
    if let Err(error) = written {
        subsurf_encoder::remove_unfinished();
        if error.kind() != ErrorKind::BrokenPipe {
            eprintln!("{}: cannot write to standard output: {error}", super::name());
        }
        std::process::exit(1);
    }
}
