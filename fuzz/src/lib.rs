//! What the fuzz targets share with the collision tests: the oracle, what must be true of an answer, pairs as bytes.

#[allow(dead_code)]
#[path = "../../tests/broad_phase/commands.rs"]
pub mod commands;
#[allow(dead_code)]
#[path = "../../tests/collision/oracle/mod.rs"]
pub mod oracle;
#[allow(dead_code)]
#[path = "../../tests/collision/pair_bytes.rs"]
pub mod pair_bytes;
#[allow(dead_code)]
#[path = "../../tests/collision/specimen.rs"]
pub mod specimen;
#[allow(dead_code)]
#[path = "../../tests/collision/verdict_of_truth.rs"]
pub mod verdict_of_truth;
