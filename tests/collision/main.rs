//! The narrow phase against closed forms, against itself turned around, and against slower ways to the same answer: above
//! all against an oracle of its own arithmetic, in `soundness`.

mod batches;
mod caches;
mod closed_forms;
#[cfg(feature = "effect-derivatives")]
mod contested;
#[cfg(feature = "effect-derivatives")]
mod derivative_pairs;
#[cfg(feature = "effect-derivatives")]
mod derivatives;
#[cfg(feature = "effect-derivatives")]
mod differences;
mod early_outs;
mod extremes;
mod fits;
mod hard_cases;
#[cfg(feature = "effect-motion")]
mod impacts;
mod known_failures;
mod laws;
mod many_pieces;
mod meshes;
mod oracle;
mod pair_bytes;
#[cfg(feature = "effect-patch")]
mod patch_regimes;
#[cfg(feature = "effect-patch")]
mod patches;
mod random_pairs;
mod rays;
mod samples;
#[cfg(feature = "effect-derivatives")]
mod smoothed_places;
#[cfg(feature = "effect-derivatives")]
mod smoothed_supports;
mod solvers;
mod soundness;
mod specimen;
mod sweep;
mod symmetry;
mod unions;
mod verdict_of_truth;
mod witness_errors;
