//! The methods that understand each option of `lodmark simplify`: for refusing the others, and for the help.
//!
//! A new method adds a group here, and the line that makes its options.
//! An option that stands in no group is understood by all methods.

use clap::{ArgMatches, Command, parser::ValueSource};

use super::SimplifyArgs;
use crate::{
    Error, Result,
    simplify::{
        MethodName::{self, Image, Memoryless, Quadric, Tolerance, ViewBounded, Visibility},
        MethodOptions,
        memoryless::MemorylessOptions,
        quadric::QuadricOptions,
        visibility::VisibilityOptions,
    },
};

/// Options that the same methods understand.
struct Group {
    /// The heading in the help.
    heading: &'static str,
    methods: &'static [MethodName],
    /// Names with `_` for `-`, in the order in which they are refused.
    options: &'static [&'static str],
}

const GROUPS: &[Group] = &[
    Group {
        heading: "Method image",
        methods: &[Image],
        options: &[
            "preset",
            "views",
            "size",
            "samples",
            "shading",
            "interior_views",
            "start_triangles",
            "polish",
            "engine",
        ],
    },
    Group {
        heading: "Method quadric",
        methods: &[Quadric],
        options: &["attributes"],
    },
    Group {
        heading: "Methods quadric and visibility",
        methods: &[Quadric, Visibility],
        options: &["probabilistic"],
    },
    Group {
        heading: "Methods memoryless, quadric and visibility",
        methods: &[Memoryless, Quadric, Visibility],
        options: &["keep_folds"],
    },
    Group {
        heading: "Method visibility",
        methods: &[Visibility],
        options: &["visibility", "cameras", "visibility_size"],
    },
    Group {
        heading: "Method view-bounded",
        methods: &[ViewBounded],
        options: &[
            "cell",
            "error_deg",
            "error_px",
            "screen_height",
            "fov",
            "bound_out",
        ],
    },
    Group {
        heading: "Method tolerance",
        methods: &[Tolerance],
        options: &["error", "error_abs", "one_sided", "volume", "growing"],
    },
];

/// The options of the chosen method.
///
/// # Errors
/// [`Error::Usage`] where one that it needs is missing or out of range; what reading a file says.
pub(super) fn method_options(args: &SimplifyArgs) -> Result<MethodOptions> {
    let mut quadric = match args.probabilistic {
        true => QuadricOptions::probabilistic(),
        false => QuadricOptions::default(),
    };
    quadric.attributes = args.attributes;
    Ok(match args.method {
        Image => MethodOptions::Image(args.image.options()?),
        Memoryless => MethodOptions::Memoryless(MemorylessOptions::default()),
        Quadric => MethodOptions::Quadric(quadric),
        Visibility => MethodOptions::Visibility(VisibilityOptions {
            quadric,
            ..args.guidance.options()
        }),
        ViewBounded => MethodOptions::ViewBounded(args.view_bound.options()?),
        Tolerance => MethodOptions::Tolerance(args.within.options()?),
    })
}

/// Puts every option of the command below the heading of the methods that understand it.
pub(in crate::rooms::cli) fn with_headings(command: Command) -> Command {
    command.mut_args(|arg| {
        let id = arg.get_id().as_str().to_owned();
        match GROUPS.iter().find(|g| g.options.contains(&id.as_str())) {
            Some(group) => arg.help_heading(group.heading),
            None => arg,
        }
    })
}

/// Refuses an option that the method would ignore.
///
/// # Errors
/// [`Error::Usage`] that names the first one.
pub(super) fn refuse_foreign(method: MethodName, matches: &ArgMatches) -> Result<()> {
    let foreign = GROUPS.iter().filter(|g| !g.methods.contains(&method));
    let given = |id: &&&str| matches.value_source(id) == Some(ValueSource::CommandLine);
    match foreign.flat_map(|g| g.options).find(given) {
        Some(id) => Err(Error::Usage(format!(
            "--{} means nothing to the method `{}`; leave it out or choose another --method",
            id.replace('_', "-"),
            method.name()
        ))),
        None => Ok(()),
    }
}
