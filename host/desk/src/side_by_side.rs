//! Contacts of bodies in space, four of a kind in the lanes of a register, where the desk spends most of its time.

use std::array;

use nalgebra::Matrix3;
use pulp::{Simd, WithSimd};
use slipfit_core::{
    Cast as _, SVector, Vector3,
    mechanism::Differentiated,
    pose::Pose,
    system::{
        AbreastBodies, Bodies, Element, JacobiansOf, LANES, Lanes, System, everywhere,
        law::{Axis, Pin, Ring, Wall},
        spatial::{FreeBodies, Placed, Port, Rim, Seat},
    },
};

use crate::{
    closing::{Approach, Gaps},
    contact::Laws,
    element::{AngularSpeeds as _, HasContacts as _, SpatialContact, SpatialElement, contact},
    out_of_line::Contacts,
    pack::Pack,
};

/// Four numbers.
type Quad<V> = Pack<V, f64>;

/// The bodies of a mechanism with what acts on them.
type Free<'a, const N: usize, const D: usize> = System<FreeBodies<f64, N, D>, &'a [SpatialElement]>;

/// Derivatives of its forces.
type Jacobians<const N: usize, const D: usize> = JacobiansOf<f64, FreeBodies<f64, N, D>, D>;

/// Contacts side by side in the registers of the machine, or lane by lane where it has none. The bits are the same.
pub enum SideBySide<const N: usize, const D: usize> {
    /// By AVX2.
    #[cfg(target_arch = "x86_64")]
    Wide(Quads<pulp::x86::V3, N, D>),
    /// By instructions that every machine has.
    ByLane(ByLane),
}

/// The elements of each lane, and those that do not make four.
pub struct ByLane {
    lanes: [Vec<SpatialContact>; LANES],
    rest: Vec<SpatialElement>,
}

/// Contacts side by side, and the proof that the machine has the instructions `V` for them.
pub struct Quads<V: Simd, const N: usize, const D: usize> {
    instructions: V,
    bodies: FreeBodies<Quad<V>, N, D>,
    quads: Vec<SpatialContact<Quad<V>>>,
    /// Those that do not make four.
    rest: Vec<SpatialElement>,
}

/// What contacts that stand side by side have in common.
#[derive(Clone, Copy, PartialEq)]
struct Kind {
    bodies: [Option<usize>; 2],
    shape: Shape,
    laws: Laws,
}

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Pin,
    Wall(Axis),
    Ring { is_turned: bool },
}

impl Kind {
    /// That of a `contact` with these `laws`.
    fn of(contact: &SpatialContact, laws: Laws) -> Self {
        let (seat, shape) = match contact {
            SpatialContact::Pin(one) => (one.link, Shape::Pin),
            SpatialContact::Wall(one) => (one.link, Shape::Wall(one.law.axis)),
            SpatialContact::Ring(one) => (one.link.seat, Shape::Ring { is_turned: one.link.axes.is_some() }),
        };
        Self { bodies: [seat.point.body, seat.from], shape, laws }
    }

    /// `four` contacts of this kind as one. A `stick_band` (m/s) stands for true stick.
    fn together<V: Simd>(&self, four: &[SpatialContact; LANES], stick_band: f64) -> Option<SpatialContact<Quad<V>>> {
        let contact = contact::<Quad<V>>(&self.laws, stick_band).ok()?;
        let [body, from] = self.bodies;
        Some(match self.shape {
            Shape::Pin => {
                let pins =
                    each(four, |contact| if let SpatialContact::Pin(one) = contact { Some(*one) } else { None })?;
                let point = Port { body, lever: vector(&pins.map(|one| one.link.point.lever)) };
                let gaps = array::from_fn(|k| Quad::<V>::of(pins.map(|one| one.law.gaps[k])));
                SpatialContact::Pin(Element { link: Seat { point, from }, law: Pin { gaps, contact } })
            }
            Shape::Wall(axis) => {
                let walls =
                    each(four, |contact| if let SpatialContact::Wall(one) = contact { Some(*one) } else { None })?;
                let point = Port { body, lever: vector(&walls.map(|one| one.link.point.lever)) };
                let [sign, gap] = [walls.map(|one| one.law.sign), walls.map(|one| one.law.gap)].map(Quad::<V>::of);
                SpatialContact::Wall(Element { link: Seat { point, from }, law: Wall { axis, sign, gap, contact } })
            }
            Shape::Ring { is_turned } => {
                let rings =
                    each(four, |contact| if let SpatialContact::Ring(one) = contact { Some(*one) } else { None })?;
                let point = Port { body, lever: vector(&rings.map(|one| one.link.seat.point.lever)) };
                let axes = is_turned.then(|| {
                    let axes = rings.map(|one| one.link.axes.unwrap_or_default());
                    Matrix3::from_fn(|i, j| Quad::<V>::of(axes.map(|axes| axes[(i, j)])))
                });
                let radius = Quad::<V>::of(rings.map(|one| one.link.radius));
                let clearance = Quad::<V>::of(rings.map(|one| one.law.clearance));
                let link = Rim { seat: Seat { point, from }, axes, radius };
                SpatialContact::Ring(Element { link, law: Ring { clearance, contact } })
            }
        })
    }
}

/// What `of` makes of each of `four` contacts; `None` where it makes nothing of one.
fn each<T>(four: &[SpatialContact; LANES], of: impl Fn(&SpatialContact) -> Option<T>) -> Option<[T; LANES]> {
    let found: Vec<T> = four.iter().filter_map(of).collect();
    found.try_into().ok()
}

/// Four vectors, each in its lane.
fn vector<V: Simd>(four: &[Vector3<f64>; LANES]) -> Vector3<Quad<V>> {
    Vector3::from_fn(|k, _| Quad::<V>::of(four.map(|vector| vector[k])))
}

impl<const N: usize, const D: usize> SideBySide<N, D> {
    /// The `elements` on the `bodies`, with the laws of each that is a contact; a `stick_band` (m/s) is used in place of true stick.
    pub fn new(
        bodies: &FreeBodies<f64, N, D>,
        elements: &[SpatialElement],
        laws: impl Iterator<Item = Option<Laws>>,
        stick_band: f64,
    ) -> Self {
        let groups = Groups::of(elements, laws);
        #[cfg(target_arch = "x86_64")]
        if let Some(instructions) = pulp::x86::V3::try_new() {
            return Self::Wide(Quads::new(instructions, bodies, groups, stick_band));
        }
        Self::ByLane(ByLane::new(groups))
    }

    /// The same without wide instructions.
    pub fn by_lane(elements: &[SpatialElement], laws: impl Iterator<Item = Option<Laws>>) -> Self {
        Self::ByLane(ByLane::new(Groups::of(elements, laws)))
    }

    /// How many times four contacts are side by side, and how many elements are not.
    pub fn counts(&self) -> (usize, usize) {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Wide(quads) => (quads.quads.len(), quads.rest.len()),
            Self::ByLane(ByLane { lanes: [lane, ..], rest }) => (lane.len(), rest.len()),
        }
    }

    /// Fills in the contacts of `system` at a `pose` and a `velocity`.
    pub fn watch(&self, system: &Free<N, D>, pose: &[Pose<f64>; N], velocity: &SVector<f64, D>, gaps: &mut Gaps) {
        let bodies = system.bodies();
        let placed = bodies.placed(pose, velocity);
        gaps.clear(bodies.max_angular_speed(&placed));
        let rest = match self {
            #[cfg(target_arch = "x86_64")]
            Self::Wide(quads) => {
                Simd::vectorize(quads.instructions, Watch { quads, placed: &placed, gaps });
                &quads.rest
            }
            Self::ByLane(ByLane { lanes, rest }) => {
                lanes
                    .iter()
                    .flatten()
                    .for_each(|one| one.approach((bodies, &placed), &mut |contact| gaps.add(contact)));
                rest
            }
        };
        rest.iter().for_each(|one| one.approach((bodies, &placed), &mut |contact| gaps.add(contact)));
    }
}

/// Contacts by their kinds, and other elements.
#[derive(Default)]
struct Groups {
    alike: Vec<(Kind, Vec<SpatialContact>)>,
    others: Vec<SpatialElement>,
}

impl Groups {
    /// The `elements` with the laws of each that is a contact.
    fn of(elements: &[SpatialElement], laws: impl Iterator<Item = Option<Laws>>) -> Self {
        let mut groups = Self::default();
        for (element, laws) in elements.iter().zip(laws) {
            let (SpatialElement::Contact(contact), Some(laws)) = (element, laws) else {
                groups.others.push(element.clone());
                continue;
            };
            let kind = Kind::of(contact, laws);
            match groups.alike.iter_mut().find(|(of, _)| *of == kind) {
                Some((_, alike)) => alike.push(*contact),
                None => groups.alike.push((kind, vec![*contact])),
            }
        }
        groups
    }

    /// Shows `four` each four of a kind; what it does not take, and what does not make four, is returned with the others.
    fn fours(self, mut four: impl FnMut(&Kind, &[SpatialContact; LANES]) -> bool) -> Vec<SpatialElement> {
        let mut rest = self.others;
        for (kind, alike) in self.alike {
            let (fours, left) = alike.as_chunks::<LANES>();
            let left = fours.iter().filter(|contacts| !four(&kind, contacts)).flatten().chain(left);
            rest.extend(left.cloned().map(SpatialElement::Contact));
        }
        rest
    }
}

impl ByLane {
    fn new(groups: Groups) -> Self {
        let mut lanes = array::from_fn(|_| Vec::new());
        let rest = groups.fours(|_, four| {
            lanes.iter_mut().zip(four).for_each(|(lane, contact): (&mut Vec<_>, _)| lane.push(*contact));
            true
        });
        Self { lanes, rest }
    }
}

impl<V: Simd, const N: usize, const D: usize> Quads<V, N, D> {
    /// The elements of `groups` on the `bodies`.
    fn new(instructions: V, bodies: &FreeBodies<f64, N, D>, groups: Groups, stick_band: f64) -> Self {
        let mut quads = Vec::new();
        let rest = groups.fours(|kind, four| match kind.together(four, stick_band) {
            Some(quad) => {
                quads.push(quad);
                true
            }
            None => false,
        });
        Self { instructions, bodies: bodies.cast(&mut everywhere), quads, rest }
    }
}

impl<const N: usize, const D: usize> Contacts<f64, Free<'_, N, D>, D> for SideBySide<N, D> {
    fn forces_by(
        &self,
        system: &Free<'_, N, D>,
        _: &Jacobians<N, D>,
        t: f64,
        pose: &[Pose<f64>; N],
        (): &(),
        velocity: &SVector<f64, D>,
        _: f64,
    ) -> SVector<f64, D> {
        let at = At { system, t, pose, velocity };
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Wide(quads) => Simd::vectorize(quads.instructions, Forces { quads, at }),
            Self::ByLane(ByLane { lanes, rest }) => {
                let At { system, t, pose, velocity } = at;
                system.forces_by_lane(&lanes.each_ref().map(|lane| &lane[..]), &&rest[..], t, pose, velocity)
            }
        }
    }

    fn differentiated(
        &self,
        system: &Free<'_, N, D>,
        t: f64,
        pose: &[Pose<f64>; N],
        (): &(),
        velocity: &SVector<f64, D>,
    ) -> Differentiated<f64, Jacobians<N, D>, D> {
        let at = At { system, t, pose, velocity };
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Wide(quads) => Simd::vectorize(quads.instructions, Derivatives { quads, at }),
            Self::ByLane(ByLane { lanes, rest }) => {
                let At { system, t, pose, velocity } = at;
                system.differentiated_by_lane(&lanes.each_ref().map(|lane| &lane[..]), &&rest[..], t, pose, velocity)
            }
        }
    }
}

/// A motion at a time (s).
struct At<'a, const N: usize, const D: usize> {
    system: &'a Free<'a, N, D>,
    t: f64,
    pose: &'a [Pose<f64>; N],
    velocity: &'a SVector<f64, D>,
}

/// Forces, to be computed with wide instructions. A type of its own, not a closure: that is not inlined here, and each number
/// would be a call.
struct Forces<'a, V: Simd, const N: usize, const D: usize> {
    quads: &'a Quads<V, N, D>,
    at: At<'a, N, D>,
}

/// Forces and their derivatives, likewise.
struct Derivatives<'a, V: Simd, const N: usize, const D: usize> {
    quads: &'a Quads<V, N, D>,
    at: At<'a, N, D>,
}

/// Contacts of bodies that are `placed`, likewise.
struct Watch<'a, V: Simd, const N: usize, const D: usize> {
    quads: &'a Quads<V, N, D>,
    placed: &'a Placed<f64, N>,
    gaps: &'a mut Gaps,
}

impl<V: Simd, const N: usize, const D: usize> WithSimd for Watch<'_, V, N, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<W: Simd>(self, _: W) {
        let Quads { bodies, quads, .. } = self.quads;
        let placed = <FreeBodies<f64, N, D> as AbreastBodies<f64, Quad<V>, D>>::everywhere(self.placed);
        let mut add = |four: Approach<Quad<V>>| self.gaps.add_four(four.lanes());
        for quad in quads {
            quad.approach((bodies, &placed), &mut add);
        }
    }
}

impl<V: Simd, const N: usize, const D: usize> WithSimd for Forces<'_, V, N, D> {
    type Output = SVector<f64, D>;

    #[inline(always)]
    fn with_simd<W: Simd>(self, _: W) -> Self::Output {
        let (Quads { bodies, quads, rest, .. }, At { system, t, pose, velocity }) = (self.quads, self.at);
        system.forces_abreast(&System::new(*bodies, &quads[..]), &&rest[..], t, pose, velocity)
    }
}

impl<V: Simd, const N: usize, const D: usize> WithSimd for Derivatives<'_, V, N, D> {
    type Output = Differentiated<f64, Jacobians<N, D>, D>;

    #[inline(always)]
    fn with_simd<W: Simd>(self, _: W) -> Self::Output {
        let (Quads { bodies, quads, rest, .. }, At { system, t, pose, velocity }) = (self.quads, self.at);
        system.differentiated_abreast(&System::new(*bodies, &quads[..]), &&rest[..], t, pose, velocity)
    }
}
