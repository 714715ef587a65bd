//! Any stream of commands: tree, sweep and prune and exhaustive search say the same, and what looking at every box says;
//! each is what it claims to be after every command.
#![no_main]

use clearance_fuzz::commands;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| commands::run(bytes, &mut commands::Reached::default()));
