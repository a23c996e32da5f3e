//! One lane of a pack: a unit's parameters in it, and its state.

use pulp::Simd;
use slipfit_core::{
    SVector, Vector3,
    integrator::Motion,
    menu::{FrictionData, SlideData},
    pose::{Orientation, Pose},
    slide::{Internal, NO_INTERNAL},
};

use crate::pack::Pack;

/// The motions of as many slides as a pack has lanes.
pub type Motions<V> = Motion<Pack<V>, Pose<Pack<V>>, Internal<()>, 6>;

/// All slides at rest in their nominal poses.
pub fn at_rest<V: Simd>() -> Motions<V> {
    let still = SVector::zeros();
    Motion { pose: Pose::nominal(), velocity: still, acceleration: still, internal: NO_INTERNAL }
}

/// Every number of where slides are and how they move.
#[inline(always)]
pub fn numbers<V: Simd>(motions: &mut Motions<V>) -> [&mut Pack<V>; 13] {
    let [a, b, c, d, e, f] = &mut motions.velocity.data.0[0];
    let Pose { displacement_w, orientation: Orientation { w, v } } = &mut motions.pose;
    let ([x, y, z], [i, j, k]) = (&mut displacement_w.data.0[0], &mut v.data.0[0]);
    [a, b, c, d, e, f, x, y, z, w, i, j, k]
}

/// Puts the slide `one` into a `lane` of `all`, its numbers rounded to single precision.
pub fn put<V: Simd>(all: &mut SlideData<Pack<V>>, lane: usize, one: &SlideData<f64>) {
    let set = |pack: &mut Pack<V>, value: f64| pack.set(lane, value as f32);
    let set_vector = |packs: &mut Vector3<Pack<V>>, values: &Vector3<f64>| {
        packs.iter_mut().zip(values.iter()).for_each(|(pack, value)| set(pack, *value));
    };
    set(&mut all.body.mass, one.body.mass);
    set_vector(&mut all.body.inertia_b, &one.body.inertia_b);
    set_vector(&mut all.body.gravity_w, &one.body.gravity_w);
    all.body.pins_w.iter_mut().zip(&one.body.pins_w).for_each(|(packs, values)| set_vector(packs, values));
    all.body.gaps.iter_mut().zip(one.body.gaps).for_each(|(pack, gap)| set(pack, gap));
    set(&mut all.contact.stiffness, one.contact.stiffness);
    set(&mut all.contact.damping, one.contact.damping);
    set(&mut all.contact.depth, one.contact.depth);
    if let (
        FrictionData::Regularised { coefficient, stick_band },
        FrictionData::Regularised { coefficient: own, stick_band: band },
    ) = (&mut all.friction, one.friction)
    {
        set(coefficient, own);
        set(stick_band, band);
    }
    set(&mut all.drive.gain, one.drive.gain);
    set(&mut all.drive.ramp_start, one.drive.ramp_start);
    set(&mut all.drive.ramp_end, one.drive.ramp_end);
    set(&mut all.drive.speed, one.drive.speed);
    set_vector(&mut all.drive.point_b, &one.drive.point_b);
}
