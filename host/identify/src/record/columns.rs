//! Which column of a file is what.

use slipfit_measured::csv::{Problem, Shown, series::Head};
use slipfit_tolerance::unit::{ANGLE, CURRENT, FORCE, LENGTH, ROTATION, SECONDS, SPEED, TORQUE, Unit, VOLTAGE};

/// The force (N) for a current of 1 A, or for a voltage of 1 V.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceConstant {
    /// N/A.
    PerAmpere(f64),
    /// N/V.
    PerVolt(f64),
}

/// Names of the columns; `None` for the usual name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// Time; usually "t" or "time".
    pub time: Option<String>,
    /// Position; usually "position" or "z".
    pub position: Option<String>,
    /// Speed; usually "speed", "velocity" or "vz".
    pub speed: Option<String>,
    /// Force; usually "force".
    pub force: Option<String>,
    /// Current or voltage that makes the force; usually "current" or "voltage".
    pub current: Option<String>,
    /// What turns the current or the voltage into a force.
    pub force_constant: Option<ForceConstant>,
    /// Whether the drive turns: positions are angles then, and forces are torques.
    pub turns: bool,
}

/// What a column is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Time,
    Position,
    Speed,
    Force,
    Current,
    Voltage,
}

impl Role {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Time => "the time",
            Self::Position => "the position",
            Self::Speed => "the speed",
            Self::Force => "the force",
            Self::Current => "the current",
            Self::Voltage => "the voltage",
        }
    }

    fn usual(self) -> &'static [&'static str] {
        match self {
            Self::Time => &["t", "time"],
            Self::Position => &["position", "z"],
            Self::Speed => &["speed", "velocity", "vz"],
            Self::Force => &["force"],
            Self::Current => &["current"],
            Self::Voltage => &["voltage"],
        }
    }

    /// The units of its column, of a drive that `turns` or pushes.
    fn units(self, turns: bool) -> &'static [Unit] {
        match self {
            Self::Position if turns => ANGLE,
            Self::Speed if turns => ROTATION,
            Self::Force if turns => TORQUE,
            Self::Time => SECONDS,
            Self::Position => LENGTH,
            Self::Speed => SPEED,
            Self::Force => FORCE,
            Self::Current => CURRENT,
            Self::Voltage => VOLTAGE,
        }
    }
}

/// A column that is read: what it is for, its index in the file, and its unit.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub role: Role,
    pub index: usize,
    pub unit: Unit,
}

impl Columns {
    /// The columns among `heads` that are wanted for `roles`, those that are absent left out.
    ///
    /// # Errors
    /// A named column that is not there, and a unit that does not fit, with the index of the column.
    pub(super) fn find(&self, heads: &[Head], roles: &[Role]) -> Result<Vec<Found>, (usize, Problem)> {
        let mut found = Vec::new();
        for role in roles.iter().copied() {
            let index = match self.named(role) {
                Some(name) => Some(heads.iter().position(|head| head.name == *name).ok_or_else(|| {
                    let columns = heads.iter().map(|head| Shown::new(&head.name).to_string()).collect::<Vec<_>>();
                    (0, Problem::NoColumn { name: Shown::new(name), role: role.name(), columns: columns.join(", ") })
                })?),
                None => {
                    heads.iter().position(|head| role.usual().iter().any(|usual| head.name.eq_ignore_ascii_case(usual)))
                }
            };
            if let Some(index) = index {
                found.push(Found {
                    role,
                    index,
                    unit: unit(&heads[index], role.units(self.turns), role).map_err(|problem| (index, problem))?,
                });
            }
        }
        Ok(found)
    }

    fn named(&self, role: Role) -> Option<&String> {
        match role {
            Role::Time => self.time.as_ref(),
            Role::Position => self.position.as_ref(),
            Role::Speed => self.speed.as_ref(),
            Role::Force => self.force.as_ref(),
            Role::Current if matches!(self.force_constant, Some(ForceConstant::PerVolt(_))) => None,
            Role::Voltage if matches!(self.force_constant, Some(ForceConstant::PerAmpere(_))) => None,
            Role::Current | Role::Voltage => self.current.as_ref(),
        }
    }
}

/// The unit of a column, which has to be one of its role's.
fn unit(head: &Head, units: &[Unit], role: Role) -> Result<Unit, Problem> {
    units.iter().find(|unit| unit.is(&head.unit)).copied().ok_or_else(|| {
        let allowed = units.iter().map(|unit| unit.symbol).collect::<Vec<_>>().join(", ");
        Problem::ColumnUnit { name: Shown::new(&head.name), unit: Shown::new(&head.unit), role: role.name(), allowed }
    })
}
