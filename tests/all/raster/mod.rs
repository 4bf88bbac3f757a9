//! The rasterizer and both un-rendering engines against oracles that share no code with them.

mod coverage;
mod lit;
mod unrender;
mod zbuffer;
