//! Writes the starting corpora, from the hard pairs of the tests: `seeds FOLDER` fills FOLDER/bracket and FOLDER/case_line.

use std::path::PathBuf;
use std::{env, fs};

use clearance_fuzz::hard_cases::hard_cases;
use clearance_fuzz::pair_bytes;

fn main() -> std::io::Result<()> {
    let folder = PathBuf::from(env::args().nth(1).expect("the folder to write to"));
    let (pairs, lines) = (folder.join("bracket"), folder.join("case_line"));
    fs::create_dir_all(&pairs)?;
    fs::create_dir_all(&lines)?;
    let mut written = 0;
    for case in hard_cases() {
        if let Some(bytes) = pair_bytes::write(&case.a, &case.b) {
            fs::write(pairs.join(&case.id), bytes)?;
            written += 1;
        }
    }
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/hard.jsonl");
    let text = fs::read_to_string(corpus)?;
    // Every tenth line: the fuzzer learns the format from a few of each kind.
    for (number, line) in text.lines().enumerate().step_by(10).filter(|(_, line)| line.len() < 4000) {
        fs::write(lines.join(number.to_string()), line)?;
    }
    println!("{written} pairs");
    Ok(())
}
