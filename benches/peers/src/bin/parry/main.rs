//! parry as a contender, in double or in single precision: `parry f64 PAIRS`, `parry f32 PAIRS`.

mod double;
mod single;

use std::env;
use std::error::Error;
use std::path::Path;

use clearance_peers::contender::serve;
use clearance_peers::pairs::Pairs;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let precision = arguments.next().unwrap_or_default();
    let path = arguments.next().ok_or("usage: parry f64|f32 PAIRS")?;
    let pairs = Pairs::read(Path::new(&path))?;
    match precision.as_str() {
        "f64" => serve(&mut double::contender::Parry::new(&pairs), &pairs)?,
        "f32" => serve(&mut single::contender::Parry::new(&pairs), &pairs)?,
        other => return Err(format!("no precision {other}").into()),
    }
    Ok(())
}
