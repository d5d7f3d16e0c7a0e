//! Files that others made: what is read, what is refused, and that no broken one makes a reader panic.

mod captures;
mod materials;
mod meshes;
mod warnings;
