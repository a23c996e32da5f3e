//! Error-controlled integration of several units of a mechanism at a time, each on a lane of vector registers.
//!
//! The units have the same bodies, joints and laws, with different parameters. Each lane has its own time and step length, and loads the
//! next unit as soon as its unit ends. The results are equal, bit for bit, to those of
//! [`integrate`](crate::error_control::integrate).

mod lanes;
mod unit;

use pulp::{Simd, WithSimd};
use slipfit_core::{
    Cast, SVector,
    integrator::{Dense, Motion, Rodas4},
    mechanism::Mechanism,
    system::{Bodies, System, planar::PlanarTree},
};
use slipfit_system::interrupt;

use lanes::Lanes;
use unit::{Wide, WidePose};

pub use unit::{Unit, UnitObserver};

use crate::{
    element::{AngularSpeeds, HasContacts, PlanarElement},
    error_control::STEPS_PER_LOOK,
};

/// `T` in numbers of several units.
type WideOf<V, T> = <T as Cast>::Of<Wide<V>>;

/// The mechanisms of some units.
type WideSystem<'w, V, B, E> = System<WideOf<V, B>, &'w [WideOf<V, E>]>;

/// Whether two units, each with its bodies and elements, have the same bodies, joints and laws, so that numbers alone differ.
pub fn same_structure<B, E>(one: (&B, &[E]), other: (&B, &[E])) -> bool
where
    B: Cast<Of<f64>: PartialEq>,
    E: Cast<Of<f64>: PartialEq>,
{
    let none = &mut |_| 0.0;
    one.0.cast(none) == other.0.cast(none)
        && one.1.len() == other.1.len()
        && one.1.iter().zip(other.1).all(|(one, other)| one.cast(none) == other.cast(none))
}

/// The bodies and elements of those of the `units` that are on the lanes: `sources` says which is on each.
fn gathered<V: Simd, B, E, const D: usize>(
    units: &[Unit<B, E, D>],
    sources: &[usize],
) -> (WideOf<V, B>, Vec<WideOf<V, E>>)
where
    B: Cast + Bodies<f64, D>,
    E: Cast,
{
    let mut numbers: Vec<Wide<V>> = Vec::new();
    for (lane, source) in sources.iter().enumerate() {
        let mut k = 0;
        let mut put = |x: f64| {
            if lane == 0 {
                numbers.push(Wide::splat(x));
            } else if let Some(number) = numbers.get_mut(k) {
                number.set(lane, x);
            }
            k += 1;
            x
        };
        let Unit { bodies, elements, .. } = &units[*source];
        bodies.cast(&mut put);
        elements.iter().for_each(|element| drop(element.cast(&mut put)));
    }
    let mut numbers = numbers.into_iter();
    let mut next = |_| numbers.next().unwrap_or_default();
    let Unit { bodies, elements, .. } = &units[sources[0]];
    (bodies.cast(&mut next), elements.iter().map(|element| element.cast(&mut next)).collect())
}

/// Integrates `units` of the same structure. The `_instructions` prove that the machine has them.
#[inline(always)]
fn integrate<V: Simd, B, E, const D: usize>(_instructions: V, units: &mut [Unit<B, E, D>])
where
    B: Cast<Of<Wide<V>>: Copy> + Bodies<f64, D>,
    E: Cast,
    WideOf<V, B>: AngularSpeeds<Wide<V>, D, Pose: WidePose<B::Pose>>,
    WideOf<V, E>: HasContacts<Wide<V>, WideOf<V, B>, D, Internal: Default>,
{
    let Some(first) = units.first() else { return };
    let still = SVector::zeros();
    let pose = WidePose::everywhere(&first.start.0);
    let mut all = Lanes::new(Motion { pose, velocity: still, acceleration: still, internal: Default::default() });
    let mut steps: u32 = 0;
    loop {
        let fresh = all.load(units);
        if !all.is_running(units.len()) {
            return;
        }
        let (bodies, elements) = gathered::<V, _, _, D>(units, &all.sources);
        let system: WideSystem<V, B, E> = System::new(bodies, &elements[..]);
        all.start_units(&system, fresh, units);
        let mut at_start = None;
        while all.is_running(units.len()) {
            if steps.is_multiple_of(STEPS_PER_LOOK) && interrupt::requested() {
                return all.interrupt(units);
            }
            steps = steps.wrapping_add(1);
            let next = all.next_step(units);
            let Motion { pose, velocity, internal, .. } = &all.motion;
            let here = match at_start {
                Some(here) => here,
                None => system.differentiated(next.t, pose, internal, velocity),
            };
            let (step, accelerations) = Rodas4::dense_step(&system, next.t, next.length, &all.motion, &here);
            let good = all.check_steps(&system, &step, &next, units);
            at_start = (good == Wide::splat(0.0)).then_some(here);
            all.accept_steps(&system, (&step.motion, &accelerations), (good, &next), units);
        }
    }
}

/// How many units of a mechanism can be integrated at a time, at most `most`; none where the machine has no registers for several.
pub fn lane_count(most: usize) -> Option<usize> {
    #[cfg(target_arch = "x86_64")]
    {
        if most >= 8 && pulp::x86::V4::try_new().is_some() {
            return Some(8);
        }
        if most >= 4 && pulp::x86::V3::try_new().is_some() {
            return Some(4);
        }
    }
    None
}

/// Bodies whose units can be simulated several at a time.
pub trait OnLanes<const D: usize>: Bodies<f64, D> + Sized {
    /// What acts on them.
    type Element;

    /// Integrates `units` of the [same structure](same_structure), whose elements [run on lanes](PlanarElement::runs_on_lanes), as many
    /// at a time as [`lane_count`] says.
    fn integrate_on_lanes(lanes: usize, units: &mut [Unit<Self, Self::Element, D>]);
}

/// Units to be integrated by wide instructions.
struct Work<'w, 'a, B: Bodies<f64, D>, E, const D: usize> {
    units: &'w mut [Unit<'a, B, E, D>],
}

/// For concrete types, so that steps are compiled in this crate and not in those that call it.
macro_rules! on_lanes {
    ($($dimension:literal),*) => { $(
        impl WithSimd for Work<'_, '_, PlanarTree<f64, $dimension>, PlanarElement<$dimension>, $dimension> {
            type Output = ();

            #[inline(always)]
            fn with_simd<V: Simd>(self, instructions: V) {
                integrate(instructions, self.units);
            }
        }

        impl OnLanes<$dimension> for PlanarTree<f64, $dimension> {
            type Element = PlanarElement<$dimension>;

            fn integrate_on_lanes(lanes: usize, units: &mut [Unit<Self, Self::Element, $dimension>]) {
                #[cfg(target_arch = "x86_64")]
                match (lanes, pulp::x86::V4::try_new(), pulp::x86::V3::try_new()) {
                    (8, Some(avx512), _) => Simd::vectorize(avx512, Work { units }),
                    (_, _, Some(avx2)) => Simd::vectorize(avx2, Work { units }),
                    _ => {}
                }
            }
        }
    )* };
}

on_lanes!(3, 6);
