//! A run by a visibility that is measured now, or was before.

use super::{VisibilityMethod, VisibilityOptions, VisibilityReport};
use crate::{
    Error, Progress, Result,
    collapse::{Rules, Schedule},
    mesh::Mesh,
    simplify::{
        MethodOptions, Options, Outcome, Report,
        methods::MethodRun,
        options::require_within,
        run::{Run, start},
    },
    visibility::{self, Visibility},
};

impl MethodRun for VisibilityOptions {
    fn check(&self) -> Result<()> {
        require_within("tie-weight", self.tie_weight, 0.0, 1.0)?;
        self.measure.check()?;
        if self.quadric.attributes {
            return Err(Error::Usage(
                "attributes mean nothing to the method `visibility`, which orders by planes alone; leave them out".into(),
            ));
        }
        self.quadric.check()
    }

    fn rules(&self) -> Rules {
        self.quadric.rules()
    }

    fn schedule(&self) -> Schedule {
        self.quadric.schedule()
    }

    fn run(&self, run: Run<'_>) -> Result<Outcome> {
        let visibility = visibility::measure(run.mesh, &self.measure, run.progress)?;
        self.run_by(&visibility, run)
    }
}

impl VisibilityOptions {
    fn run_by(&self, visibility: &Visibility, run: Run<'_>) -> Result<Outcome> {
        let mut method = VisibilityMethod::new(&run.live, self, visibility.triangles())?;
        let v_mesh = visibility.mesh();
        let report = Report::Visibility(VisibilityReport { v_mesh });
        run.collapse("visibility", &mut method, report)
    }
}

/// Simplifies as [`simplify_with`](crate::simplify::simplify_with) does with the method [`MethodOptions::Visibility`],
/// by a visibility of this very mesh that was measured before: it is measured once, and guides any number of runs. The
/// result is that of a run with the options that it was measured with, and its [`Outcome::options`] have them.
///
/// # Errors
/// As [`simplify_with`](crate::simplify::simplify_with); [`Error::Usage`] for another method, and for a visibility of
/// another number of triangles.
pub fn simplify_guided(
    mesh: &Mesh,
    options: &Options,
    visibility: &Visibility,
    progress: &dyn Progress,
) -> Result<Outcome> {
    let MethodOptions::Visibility(own) = &options.method else {
        return Err(Error::Usage(format!(
            "the method `{}` has no use for a visibility; use the method `visibility`",
            options.method.name()
        )));
    };
    let own = VisibilityOptions {
        measure: *visibility.options(),
        ..own.clone()
    };
    let options = Options {
        method: own.clone().into(),
        ..options.clone()
    };
    start(mesh, &options, progress, &|_, run| {
        own.run_by(visibility, run)
    })
}
