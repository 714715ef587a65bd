//! What the fuzz targets share: the oracle of the collision tests, and pairs of shapes as bytes.

#[allow(dead_code)]
#[path = "../../tests/collision/hard_cases.rs"]
pub mod hard_cases;
#[allow(dead_code)]
#[path = "../../tests/collision/oracle/mod.rs"]
pub mod oracle;
pub mod pair_bytes;
#[allow(dead_code)]
#[path = "../../tests/collision/specimen.rs"]
pub mod specimen;
#[allow(dead_code)]
#[path = "../../tests/collision/verdict_of_truth.rs"]
pub mod verdict_of_truth;
