//! The rasterizer and both un-rendering engines against oracles that share no code with them.

mod coverage;
mod unrender;
mod zbuffer;
