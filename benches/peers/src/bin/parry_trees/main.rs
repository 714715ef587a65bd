//! parry's `Bvh` as a contender, in double or in single precision: `parry_trees f64`, `parry_trees f32`.

mod double;
mod single;

use std::env;
use std::error::Error;

use clearance_peers::trees::{Counted, serve};

#[global_allocator]
static ALLOCATOR: Counted = Counted;

fn main() -> Result<(), Box<dyn Error>> {
    match env::args().nth(1).as_deref() {
        Some("f64") => serve::<double::contender::Parry>()?,
        Some("f32") => serve::<single::contender::Parry>()?,
        _ => return Err("usage: parry_trees f64|f32".into()),
    }
    Ok(())
}
