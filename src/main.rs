//! The command line; `clearance --help` lists the commands.

fn main() {}
