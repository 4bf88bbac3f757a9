//! Reasons why a collapse is not allowed, and how often each was met.
//!
//! Rules that hold for every method are named here; a method names its own as [`Reason`]s.

use serde::Serialize;

macro_rules! refusals {
    ($($(#[doc = $doc:literal])+ $name:ident => $key:literal,)+) => {
        /// A reason why a collapse is not allowed.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Refusal {
            $($(#[doc = $doc])+ $name,)+
            /// A reason of the method's own.
            Method(&'static Reason),
        }

        /// Places of the rules.
        enum Place { $($name,)+ }

        impl Refusal {
            /// Every rule, in the order in which they are tested.
            const RULES: &[Self] = &[$(Self::$name,)+];

            /// The name in reports.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$name => $key,)+
                    Self::Method(reason) => reason.name,
                }
            }

            /// Place in the order of reports.
            const fn place(self) -> usize {
                match self {
                    $(Self::$name => Place::$name as usize,)+
                    Self::Method(reason) => Self::RULES.len() + reason.index,
                }
            }
        }
    };
}

refusals! {
    /// More than [`STAR_LIMIT`](super::legality::STAR_LIMIT) faces touch the edge, or than the method's plan allows.
    Valence => "valence",
    /// Nothing would be left of the mesh, or of a material.
    LastTriangle => "last-triangle",
    /// A mesh of the document would have less than its own share of the target.
    Share => "share",
    /// A common neighbour of both ends forms no face with them: a hole or handle would close.
    Link => "link",
    /// An edge inside joins two boundary (or pinched, or non-manifold) vertices: the surface would be pinched there.
    Pinch => "pinch",
    /// A triangle with two boundary edges would vanish, or a loop of three boundary edges would close.
    Ear => "ear",
    /// Both ends are corners of the boundary or of a non-manifold curve.
    Corner => "corner",
    /// Two faces would coincide.
    Duplicate => "duplicate",
    /// Both ends are locked, or one is and the other may not move there.
    Locked => "locked",
    /// The edge is no feature but both ends lie on features: a chart would be pinched.
    FeaturePinch => "feature-pinch",
    /// Both ends are ends or branchings of features.
    FeatureCorner => "feature-corner",
    /// The method found no position, or the file's precision cannot hold it.
    Unplaced => "unplaced",
    /// A face would become degenerate.
    Degenerate => "degenerate",
    /// A face would turn too far.
    Flip => "flip",
    /// Two neighbouring faces would fold onto each other.
    Fold => "fold",
    /// A face would be mirrored in texture space.
    Mirror => "mirror",
    /// The method refuses what it proposed itself.
    Unconfirmed => "method",
}

/// A method's own reason to refuse a collapse. Reports list those of a method after the common rules, by `index`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Reason {
    /// Place among the method's reasons, below [`Reason::MOST`].
    pub index: usize,
    /// The name in reports.
    pub name: &'static str,
    /// True where an error would exceed the bound that the user gave.
    pub is_bound: bool,
}

impl Reason {
    /// Most reasons that a method has.
    pub const MOST: usize = 4;

    /// The reason of a place, a name, and whether it is the user's bound.
    pub(crate) const fn new(index: usize, name: &'static str, is_bound: bool) -> Self {
        Self {
            index,
            name,
            is_bound,
        }
    }
}

/// Counts by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refusals {
    counts: [u64; Refusal::RULES.len() + Reason::MOST],
    own: [Option<&'static Reason>; Reason::MOST],
}

impl Refusals {
    /// Counts one.
    pub fn add(&mut self, refusal: Refusal) {
        self.add_many(refusal, 1);
    }

    /// Adds the counts of another run.
    pub(super) fn add_all(&mut self, other: &Self) {
        for (refusal, count) in other.iter() {
            self.add_many(refusal, count);
        }
    }

    fn add_many(&mut self, refusal: Refusal, more: u64) {
        if let Refusal::Method(reason) = refusal {
            self.own[reason.index] = Some(reason);
        }
        self.counts[refusal.place()] += more;
    }

    /// The count of one reason.
    #[must_use]
    pub fn count(&self, refusal: Refusal) -> u64 {
        self.counts[refusal.place()]
    }

    /// The sum over all reasons.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Every reason that was met at least once, with its count.
    pub fn iter(&self) -> impl Iterator<Item = (Refusal, u64)> {
        let own = self.own.iter().flatten().map(|r| Refusal::Method(r));
        let all = Refusal::RULES.iter().copied().chain(own);
        all.map(|refusal| (refusal, self.count(refusal)))
            .filter(|&(_, count)| count > 0)
    }

    /// True where the bound that the user gave refused anything.
    #[must_use]
    pub fn by_bound(&self) -> bool {
        self.own.iter().flatten().any(|reason| reason.is_bound)
    }
}

impl std::fmt::Display for Refusals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rules: Vec<String> = self
            .iter()
            .map(|(r, count)| format!("{}: {count}", r.name()))
            .collect();
        f.write_str(&rules.join(", "))
    }
}

impl Serialize for Refusals {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.iter().map(|(r, count)| (r.name(), count)))
    }
}
