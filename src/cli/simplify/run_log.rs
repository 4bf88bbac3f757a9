//! The log of a run of simplification on stderr: its phases, guarantees and end.

use std::path::Path;

use crate::{
    cli::terminal::Terminal,
    mesh::Mesh,
    simplify::{
        Normals, NormalsReport, Outcome, Phase, Stop, TangentsReport, image::PolishCounters,
    },
};

/// Prints phases, guarantees and the way the run ended, in particular where that is short of the target.
pub(super) fn tell(input: &Path, triangles_in: usize, outcome: &Outcome, terminal: &Terminal) {
    for phase in &outcome.phases {
        tell_phase(phase, terminal);
    }
    if let Some(v) = outcome.v_mesh() {
        terminal.say(&format!("visibility of the input: {v:.4}"));
    }
    if let Some(polish) = outcome.polish() {
        tell_polish(polish, terminal);
    }
    if let Some(rms) = outcome.error_rms() {
        terminal.say(&format!("RMS over the driving views: {rms:.3} levels"));
    }
    if let Some(c) = outcome.comparison() {
        let returned = match c.fell_back {
            true => "; the memoryless result is returned",
            false => "",
        };
        terminal.say(&format!(
            "RMS over views that drove nothing: {:.3} levels, by the memoryless method {:.3}{returned}",
            c.image, c.memoryless
        ));
    }
    if let Some(g) = outcome.guarantee() {
        terminal.say(&format!(
            "guaranteed: no point of the result is farther than {:.6e} from the input{}",
            g.distance,
            if g.two_sided { ", nor back" } else { "" }
        ));
    }
    if outcome.locked_vertices > 0 {
        terminal.say(&format!(
            "{} vertices were locked and stayed where they are",
            outcome.locked_vertices
        ));
    }
    if let Some(report) = outcome.weights {
        terminal.say(&format!(
            "weights: {} of {} vertices of weight 1 are in the result where they were; mean weight {:.3} of vertices that \
             stayed, {:.3} of those that are gone",
            report.held, report.locked, report.mean_kept, report.mean_removed
        ));
    }
    if let Some(report) = outcome.normals {
        tell_normals(report, terminal);
    }
    tell_stop(input, triangles_in, outcome, terminal);
}

/// Triangles that the scene draws before and after, each as often as its part is shown; `None` where every part is shown
/// once.
pub(super) fn triangles_drawn(mesh: &Mesh, outcome: &Outcome) -> Option<[usize; 2]> {
    let drawn = [mesh, &outcome.mesh].map(|m| {
        let triangles = 0..m.triangles().len();
        triangles.map(|t| m.materials().instances(t)).sum::<usize>()
    });
    let stored = [mesh, &outcome.mesh].map(|m| m.triangles().len());
    (drawn != stored).then_some(drawn)
}

fn tell_normals(report: NormalsReport, terminal: &Terminal) {
    let made = match report.normals {
        Normals::Fit => "fitted",
        Normals::Carry => "carried",
        Normals::Recompute => "recomputed",
        Normals::Drop => "dropped",
    };
    terminal.say(&format!(
        "normals {made}: {} vertices are stored, {} as the collapses left them",
        report.stored_vertices, report.stored_vertices_carried
    ));
}

/// Tells of tangents that were asked for.
pub(super) fn tell_tangents(report: Option<TangentsReport>, terminal: &Terminal) {
    terminal.say(&match report {
        Some(TangentsReport {
            triangles,
            triangles_without,
            stored_vertices,
        }) => format!(
            "tangents recomputed: of {triangles} triangles; {triangles_without} have no texture coordinates or no normals; \
             {stored_vertices} vertices are stored"
        ),
        None => "no tangents were made: the result is a copy, or has no texture coordinates or no normals".into(),
    });
}

fn tell_phase(phase: &Phase, terminal: &Terminal) {
    let c = &phase.counters;
    let broken = match c.seams_broken {
        0 => String::new(),
        count => format!(" (seams broken: {count})"),
    };
    let concession = phase.concession;
    let concession = concession.map(|c| format!(", {} give way{broken}", c.name()));
    terminal.say(&format!(
        "{}{}: {} -> {} triangles in {} collapses; {} evaluations (eager: {})",
        phase.method,
        concession.unwrap_or_default(),
        phase.triangles_in,
        phase.triangles_out,
        c.collapses,
        c.evaluations,
        c.evaluations_if_eager
    ));
    if !c.ranks.is_empty() {
        let mean = c.ranks.iter().sum::<f64>() / c.ranks.len() as f64;
        terminal.say(&format!(
            "{}: collapsed edges ranked at {:.3} % of the legal ones on average ({} measured)",
            phase.method,
            100.0 * mean,
            c.ranks.len()
        ));
    }
}

fn tell_polish(polish: &PolishCounters, terminal: &Terminal) {
    let (moves, flips, evaluations) = (polish.moves, polish.flips, polish.evaluations);
    terminal.say(&format!(
        "polish: {moves} moves, {flips} flips; {evaluations} evaluations"
    ));
    for (i, [before, after]) in polish.cameras.iter().enumerate() {
        let before_that = match i {
            0 => "",
            _ => ", which had driven nothing",
        };
        terminal.say(&format!(
            "polish: RMS from {before:.3} to {after:.3} levels over camera set {}{before_that}",
            i + 1
        ));
    }
}

fn tell_stop(input: &Path, triangles_in: usize, outcome: &Outcome, terminal: &Terminal) {
    match &outcome.stop {
        Stop::TargetReached => {}
        Stop::TargetAboveInput => terminal.say(&format!(
            "{}: already has {triangles_in} triangles; the result is a copy",
            input.display()
        )),
        Stop::ErrorLimit => terminal.say("stopped at the error limit"),
        Stop::NoLegalCollapse { refusals } if refusals.by_bound() => {
            terminal.say(&format!(
                "stopped with {} triangles: every collapse that is left breaks the bound or a rule ({refusals})",
                outcome.mesh.triangles().len()
            ));
        }
        Stop::VisiblePieces { pieces } => terminal.say(&format!(
            "stopped with {} triangles: {pieces} separate pieces are seen, and each keeps one; try --drop-pieces",
            outcome.mesh.triangles().len()
        )),
        Stop::NoLegalCollapse { refusals } => terminal.say(&format!(
            "stopped with {} triangles: no edge may be collapsed any more ({refusals})",
            outcome.mesh.triangles().len()
        )),
    }
}
