//! Robots and mesh files, from text and bytes to poses and shapes.

mod ur5;
