//! Every integration test in one binary: a module per stage.

mod architecture;
mod collapse;
mod history;
mod memoryless;
mod quadric;
mod seams;
mod shapes;
