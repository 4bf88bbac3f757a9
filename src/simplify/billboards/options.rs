//! Options of a billboard cloud.

use super::Up;
use crate::{Error, Result, bound::planar::Aperture};

/// Most directions of the grid.
const DIRECTION_LIMIT: u32 = 4096;

/// A limit on the displacement of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// So that no viewer of the cell sees it under more than an angle across the horizon.
    Angle(Aperture),
    /// By a distance, wherever viewers are: the view-independent billboard cloud (Décoret et al. 2003) by the same
    /// selection, to compare with. Not negative, finite.
    Distance(f64),
}

/// Options of a billboard cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BillboardOptions {
    /// The limit on the displacement of points.
    pub limit: Limit,
    /// The axis that points up.
    pub up: Up,
    /// Directions of the grid of planes over half a turn, 1 to 4096, where viewers bound the displacement each with nine
    /// directions of projection; planes along walls and between the directions of the grid are tried too.
    pub directions: u32,
    /// Most texels in a row or column of a texture, 1 to 4096.
    pub texels: u32,
    /// Puts all horizontal faces at one height: as in the paper nothing then bounds how far they go up or down.
    pub any_height: bool,
}

impl BillboardOptions {
    /// Directions of the grid unless asked for others: 1 degree apart.
    pub const DIRECTIONS: u32 = 180;
    /// Most texels in a row or column unless asked for others.
    pub const TEXELS: u32 = 1024;

    /// With the z-axis up, horizontal faces bounded in height, and the defaults above.
    pub fn within(limit: Limit) -> Self {
        Self {
            limit,
            up: Up::Z,
            directions: Self::DIRECTIONS,
            texels: Self::TEXELS,
            any_height: false,
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        let refused = |what: String| Err(Error::Usage(what));
        if self.directions == 0 || self.directions > DIRECTION_LIMIT {
            return refused(format!(
                "{} directions of planes; expected 1 to {DIRECTION_LIMIT}",
                self.directions
            ));
        }
        let most = crate::view::SIDE_LIMIT;
        if self.texels == 0 || self.texels > most {
            return refused(format!(
                "textures of {} texels a side; expected 1 to {most}",
                self.texels
            ));
        }
        match self.limit {
            Limit::Distance(d) if !(0.0..f64::INFINITY).contains(&d) => refused(format!(
                "a distance of {d}; expected a finite length that is not negative"
            )),
            _ => Ok(()),
        }
    }
}
