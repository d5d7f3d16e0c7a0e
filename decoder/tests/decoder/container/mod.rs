//! Containers: header, section table and what a file holds.

mod families;
mod table;
