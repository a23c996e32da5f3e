//! A body on its contacts: where it comes to lie in each unit.

use crate::numeric::lanes::{LANES, Lanes};

use super::{
    contact::{CONDITIONS, Contact, Freedoms, Rows},
    feature::{Feature, Located},
    float::Float,
    vector::Displacement,
};

/// Newton passes with the nominal Jacobian. Each gains the factor of the parts' rotations, a thousandth or less.
const PASSES: usize = 3;
/// Passes after which a unit that has not come to rest counts as one that cannot be assembled.
const MOST_PASSES: usize = 40;
/// The last correction of a unit that has come to rest, over the size of the contacts: what is left is a part of it.
const AT_REST: f64 = 1e-8;
/// Passes for the nominal place.
const NOMINAL_PASSES: usize = 50;

/// Contacts that leave a body no freedom.
#[derive(Clone, Debug)]
pub struct Contacts {
    joined: Vec<Joined>,
    centre: [f64; 3],
    /// Size (m) of the contacts.
    scale: f64,
    start: [f64; 6],
    /// Of each contact, components of the displacement per condition.
    gains: Vec<Vec<Gain>>,
    /// Motions that the contacts leave a frame of datums: shifts (m) and rotations (rad) about the centre.
    free: Vec<[[f64; 3]; 2]>,
}

/// A contact of two features.
#[derive(Clone, Debug)]
pub struct Joined {
    /// Conditions.
    pub contact: Contact,
    /// The feature of the body.
    pub own: Own,
    /// The feature that it meets.
    pub other: usize,
    /// The plane that the body lies on by a contact before this one.
    about: Option<usize>,
    /// The play between both.
    pub float: Option<Float>,
    /// Which of its conditions count where not all can be met.
    pub order: Order,
}

/// Which conditions of a contact have precedence where those before it do not leave room for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// None: the body turns by a least-squares fit of places and tilts.
    LeastSquares,
    /// Tilts.
    Orientation,
    /// Places.
    Location,
}

/// A feature of the body that is placed.
#[derive(Clone, Copy, Debug)]
pub enum Own {
    /// As it was made.
    Made(usize),
    /// As it is nominally: a frame of datums is perfect.
    Perfect(usize),
}

#[derive(Clone, Copy, Debug)]
struct Gain {
    condition: usize,
    component: usize,
    factor: f64,
}

/// Why a body has no definite place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// The contact with this index holds nothing that those before it leave free.
    #[error("this contact holds nothing that the ones before it leave free: the part is over-constrained")]
    Over(usize),
    /// Too little is held.
    #[error("the part is under-constrained: {left} of 6 freedoms are left, it can still {motion}")]
    Under {
        /// Freedoms left.
        left: usize,
        /// One of them.
        motion: String,
    },
    /// The contacts cannot all close near the nominal place.
    #[error("the contacts cannot be closed at the nominal values")]
    Open,
    /// The contacts do not close within the tolerances.
    #[error("the contacts cannot be closed in {units} of {of} units")]
    OpenUnits {
        /// Units in which they do not.
        units: usize,
        /// Units that were tried.
        of: usize,
    },
}

impl Contacts {
    /// Contacts of the `features`, `located` where they are at the `nominal` values; the first with precedence over the next. Other
    /// freedoms are `fixed`: directions of shifts, and of rotations about the centre.
    ///
    /// # Errors
    /// [`PlacementError`].
    pub fn new(
        features: &[Feature],
        nominal: &[Lanes],
        located: &[Located],
        mut contacts: Vec<Joined>,
        fixed: &[[[f64; 3]; 2]],
    ) -> Result<Self, PlacementError> {
        let mut plane = None;
        for joined in &mut contacts {
            joined.about = plane;
            plane = plane.or(joined.contact.is_of_planes().then_some(joined.other));
        }
        let places = contacts.iter().map(|joined| joined.own.feature()).map(|i| features[i].nominal[0]);
        let count = contacts.len().max(1) as f64;
        let centre = places.clone().fold([0.0; 3], |sum, place| [0, 1, 2].map(|i| sum[i] + place[i] / count));
        let spread = places.map(|place| (0..3).map(|i| (place[i] - centre[i]).abs()).fold(0.0, f64::max));
        let reaches = contacts.iter().map(|joined| features[joined.own.feature()].reach);
        let scale = Some(spread.chain(reaches).fold(0.0, f64::max)).filter(|size| *size > 0.0).unwrap_or(1.0);
        let mut made = Self { joined: contacts, centre, scale, start: [0.0; 6], gains: Vec::new(), free: Vec::new() };

        for _ in 0..NOMINAL_PASSES {
            made.linearise(features, nominal, located, fixed)?;
            let start = made.start.map(Lanes::splat);
            let change = made.correction(features, nominal, located, &start);
            for (component, change) in made.start.iter_mut().zip(change) {
                *component -= change.0[0];
            }
            if change.iter().all(|change| change.0[0].abs() < 1e-15) {
                break;
            }
        }
        let residual = made.correction(features, nominal, located, &made.start.map(Lanes::splat));
        let closed = residual.iter().all(|change| change.0[0].abs() < 1e-12);
        if closed { Ok(made) } else { Err(PlacementError::Open) }
    }

    /// Finds the gains at `self.start`.
    fn linearise(
        &mut self,
        features: &[Feature],
        nominal: &[Lanes],
        located: &[Located],
        fixed: &[[[f64; 3]; 2]],
    ) -> Result<(), PlacementError> {
        const STEP: f64 = 1e-6;
        let scale = self.scale;
        let mut derivatives = vec![Rows::zeros(); self.joined.len()];
        for component in 0..6 {
            let step = if component < 3 { STEP * scale } else { STEP };
            let mut moved = self.start.map(Lanes::splat);
            moved[component].0[0] += step;
            moved[component].0[1] -= step;
            let displacement = Displacement::new(&moved, self.centre);
            for (rows, joined) in derivatives.iter_mut().zip(&self.joined) {
                for (row, condition) in joined.conditions(features, nominal, located, &displacement).iter().enumerate()
                {
                    rows[(row, component)] = (condition.0[0] - condition.0[1]) / (2.0 * STEP * scale);
                }
            }
        }
        let mut freedoms = Freedoms::all();
        let mut combinations = Vec::new();
        for (i, rows) in derivatives.iter().enumerate() {
            let held: Vec<_> =
                self.joined[i].stages(rows).iter().flatten().flat_map(|stage| freedoms.hold(stage)).collect();
            if held.is_empty() {
                return Err(PlacementError::Over(i));
            }
            combinations.extend(held.into_iter().map(|combination| (i, combination)));
        }
        for [shift, turn] in fixed {
            let row = [shift[0], shift[1], shift[2], turn[0], turn[1], turn[2]];
            let held = freedoms.hold(&Rows::from_fn(|i, column| if i == 0 { row[column] } else { 0.0 }));
            if held.is_empty() {
                return Err(PlacementError::Over(self.joined.len()));
            }
        }
        if self.joined.iter().any(|joined| matches!(joined.own, Own::Perfect(_))) {
            self.free =
                freedoms.rest().iter().map(|m| [[m[0], m[1], m[2]].map(|x| x * scale), [m[3], m[4], m[5]]]).collect();
            freedoms.hold_the_rest();
        }
        let Some(inverse) = freedoms.inverse() else {
            let motion = freedoms.one().map(|motion| describe(motion.as_slice())).unwrap_or_default();
            return Err(PlacementError::Under { left: freedoms.count(), motion });
        };
        let mut gains = vec![[[0.0; 6]; CONDITIONS]; self.joined.len()];
        for (row, (contact, combination)) in combinations.iter().enumerate() {
            for (gains, weight) in gains[*contact].iter_mut().zip(combination) {
                for (component, gain) in gains.iter_mut().enumerate() {
                    let unscaled = if component < 3 { 1.0 } else { 1.0 / scale };
                    *gain += inverse[(component, row)] * weight * unscaled;
                }
            }
        }
        let greatest = gains.iter().flatten().flatten().fold(0.0, |most: f64, gain| most.max(gain.abs()));
        let sparse = |gains: &[[f64; 6]; CONDITIONS]| -> Vec<Gain> {
            let all = gains.iter().enumerate().flat_map(|(condition, row)| {
                row.iter().enumerate().map(move |(component, factor)| Gain { condition, component, factor: *factor })
            });
            // What the difference quotients and the eigenvectors leave of a zero.
            all.filter(|gain| gain.factor.abs() > 1e-8 * greatest).collect()
        };
        self.gains = gains.iter().map(sparse).collect();
        Ok(())
    }

    /// What a Newton pass takes off the components of the displacement.
    #[inline(always)]
    fn correction(
        &self,
        features: &[Feature],
        variables: &[Lanes],
        located: &[Located],
        components: &[Lanes; 6],
    ) -> [Lanes; 6] {
        let displacement = Displacement::new(components, self.centre);
        let mut change = [Lanes::ZERO; 6];
        for (joined, gains) in self.joined.iter().zip(&self.gains) {
            let conditions = joined.conditions(features, variables, located, &displacement);
            for gain in gains {
                change[gain.component] += conditions[gain.condition] * gain.factor;
            }
        }
        change
    }

    /// Motions that the contacts leave a frame of datums, as shifts (m) and rotations (rad), and the point (m) about which it
    /// turns.
    pub fn free(&self) -> (&[[[f64; 3]; 2]], [f64; 3]) {
        (&self.free, self.centre)
    }

    /// How far (m) the body is drawn off its contacts, and how far (rad) turned; none if by less than 1e-5 of their size.
    pub fn drawn_off(&self) -> Option<[f64; 2]> {
        const NEGLIGIBLE: f64 = 1e-5;
        let length = |vector: &[f64]| libm::sqrt(vector.iter().map(|x| x * x).sum());
        let (shift, turn) = self.start.split_at(3);
        let (shift, turn) = (length(shift), 2.0 * libm::atan(0.5 * length(turn)));
        (shift.max(turn * self.scale) > NEGLIGIBLE * self.scale).then_some([shift, turn])
    }

    /// Where the body comes to lie; not a number where its contacts do not close.
    #[inline(always)]
    pub fn displacement(&self, features: &[Feature], variables: &[Lanes], located: &[Located]) -> Displacement {
        let mut components = self.start.map(Lanes::splat);
        let mut change = [Lanes::ZERO; 6];
        for _ in 0..PASSES {
            change = self.correction(features, variables, located, &components);
            for (component, change) in components.iter_mut().zip(change) {
                *component -= change;
            }
        }
        let size = self.size(&change);
        // Hardly any unit is that far off.
        if size.0.iter().any(|size| size.is_nan() || *size > AT_REST) {
            self.go_on(features, variables, located, &mut components, size);
        }
        Displacement::new(&components, self.centre)
    }

    /// The size of a correction over that of the contacts.
    #[inline(always)]
    fn size(&self, change: &[Lanes; 6]) -> Lanes {
        let size = |lane: usize| {
            let shift = (0..3).map(|i| change[i].0[lane].abs() / self.scale);
            shift
                .chain((3..6).map(|i| change[i].0[lane].abs()))
                .fold(0.0, |most, x| if x > most || x.is_nan() { x } else { most })
        };
        Lanes(std::array::from_fn(size))
    }

    /// Further passes for the units that are not at rest, each by itself: a unit does not depend on its neighbours.
    #[cold]
    fn go_on(
        &self,
        features: &[Feature],
        variables: &[Lanes],
        located: &[Located],
        components: &mut [Lanes; 6],
        mut size: Lanes,
    ) {
        let moving = |size: &Lanes| size.map(|size| f64::from(u8::from(size.is_nan() || size > AT_REST)));
        for _ in PASSES..MOST_PASSES {
            let still = moving(&size);
            if still == Lanes::ZERO {
                return;
            }
            let change = self.correction(features, variables, located, components);
            let now = self.size(&change);
            for lane in (0..LANES).filter(|lane| still.0[*lane] > 0.0) {
                components.iter_mut().zip(&change).for_each(|(component, change)| component.0[lane] -= change.0[lane]);
                size.0[lane] = now.0[lane];
            }
        }
        let still = moving(&size);
        for lane in (0..LANES).filter(|lane| still.0[*lane] > 0.0) {
            components.iter_mut().for_each(|component| component.0[lane] = f64::NAN);
        }
    }

    /// Calls `fit` with the number of each fit and of units in which it does not go together.
    pub fn misfits(
        &self,
        features: &[Feature],
        variables: &[Lanes],
        located: &[Located],
        displacement: &Displacement,
        fit: &mut impl FnMut(usize, usize),
    ) {
        let plays = self.joined.iter().filter_map(|joined| joined.float).map(|float| float.half_play(variables));
        let room = plays.fold(Lanes::splat(1e-9), |room, play| room + play.map(|play| play.max(0.0)));
        for joined in &self.joined {
            let Some(float) = &joined.float else { continue };
            let Some(number) = float.fit else { continue };
            let [x, y, ..] = joined.conditions(features, variables, located, displacement);
            fit(number, float.misfits(variables, (x * x + y * y).map(libm::sqrt), room));
        }
    }
}

impl Joined {
    /// A feature of the body that meets an `other`.
    pub fn new(contact: Contact, own: Own, other: usize, float: Option<Float>, order: Order) -> Self {
        Self { contact, own, other, float, order, about: None }
    }

    /// The derivatives of the conditions that are met first, and those of the others.
    fn stages(&self, rows: &Rows) -> [Option<Rows>; 2] {
        let some = |places: bool| {
            let mut some = *rows;
            let count = self.contact.places();
            some.row_iter_mut()
                .enumerate()
                .filter(|(i, _)| (*i < count) != places)
                .for_each(|(_, mut row)| row.fill(0.0));
            Some(some)
        };
        match self.order {
            Order::LeastSquares => [Some(*rows), None],
            Order::Orientation => [some(false), some(true)],
            Order::Location => [some(true), some(false)],
        }
    }

    /// The conditions at a displacement of the body.
    #[inline(always)]
    fn conditions(
        &self,
        features: &[Feature],
        variables: &[Lanes],
        located: &[Located],
        displacement: &Displacement,
    ) -> [Lanes; CONDITIONS] {
        let own = match self.own {
            Own::Made(feature) => located[feature].displaced(displacement),
            Own::Perfect(feature) => features[feature].perfect().displaced(displacement),
        };
        let about = self.about.map(|plane| &located[plane].direction);
        let mut conditions = self.contact.conditions(&own, &located[self.other], about);
        if let Some(float) = &self.float {
            float.take_off(variables, &mut conditions);
        }
        conditions
    }
}

impl Own {
    fn feature(self) -> usize {
        let (Self::Made(feature) | Self::Perfect(feature)) = self;
        feature
    }
}

/// A motion in words, by its greatest part.
pub fn describe(motion: &[f64]) -> String {
    let (shift, turn) = motion.split_at(3);
    let size = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>();
    let (verb, part) = if size(turn) > size(shift) { ("turn about", turn) } else { ("move along", shift) };
    let length = libm::sqrt(size(part));
    let [x, y, z] = [0, 1, 2].map(|i| crate::number::fixed(part[i] / length, 2));
    format!("{verb} ({x}, {y}, {z})")
}
