//! The three broad phases against each other and against looking at every box: on boxes alone, and in scenes.

mod commands;
mod large;
mod random;
mod scenes;
mod streams;
