//! The study, run once by the command with a small budget, and its folder read as a reader would.
//!
//! What is checked are proofs and figures' presence, never that something is fast: errors within certified widths, brackets
//! that hold the truth, widths no larger than asked or than rounding lets through, every regime there, times positive.

mod folder;
mod page;
mod regimes;
mod widths;
