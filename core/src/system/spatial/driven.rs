//! What a drive sees of a body: a speed along an axis, or about one.

use nalgebra::Matrix3;

use super::{
    FreeBodies, Placed, PlacedBody,
    blocks::{add_blocks, add_wrench},
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::{Blocks, cross_matrix, twice_crossed},
    product::{cross, dot, outer, times},
    system::{Law, Link, Response, Seen},
};

/// A point of a body along an axis of the frame, and the body's centre of mass, whose speed along it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<S> {
    /// The body; one that is not there stands still.
    pub body: usize,
    /// Where the force acts (m), from the centre of mass in the body's axes.
    pub lever: Vector3<S>,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

/// A point of a body along an axis of the frame, where the speed counts, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtPoint<S> {
    /// The body; one that does not exist is at rest.
    pub body: usize,
    /// The point (m), from the centre of mass in the body's axes.
    pub lever: Vector3<S>,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

/// How fast a body turns about an axis of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct About<S> {
    /// The body; one that is not there stands still.
    pub body: usize,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

/// `R` speeds of one body, and how they go by its motion.
#[derive(Clone, Copy, Debug)]
pub struct Speeds<S, const R: usize> {
    /// The speeds (m/s, rad/s).
    rate: SVector<S, R>,
    /// By the velocity of the centre of mass, in the axes of the frame, as all below.
    by_velocity: [Vector3<S>; R],
    /// By the angular velocity.
    by_turning: [Vector3<S>; R],
    /// By a small turn of the body, its velocities held.
    by_turn: [Vector3<S>; R],
}

impl<S: Scalar, const R: usize> Speeds<S, R> {
    /// Those of a body `at` a pose and motion.
    #[inline(always)]
    fn new(at: &PlacedBody<S>, [by_velocity, by_turning, by_turn]: [[Vector3<S>; R]; 3]) -> Self {
        let mut rate = SVector::<S, R>::zeros();
        for ((rate, by_velocity), by_turning) in rate.data.0[0].iter_mut().zip(&by_velocity).zip(&by_turning) {
            *rate = dot(by_velocity, &at.velocity_w) + dot(by_turning, &at.rotation_w);
        }
        Self { rate, by_velocity, by_turning, by_turn }
    }

    /// How forces on the body go by its motion where they change with the speeds by `impedance`, and these with the motion by the
    /// rows `by_velocity` and `by_turning`.
    #[inline(always)]
    fn blocks<W: Law<S, R>>(
        &self,
        impedance: &SMatrix<S, R, R>,
        [by_velocity, by_turning]: [&[Vector3<S>; R]; 2],
    ) -> Blocks<S> {
        let mut blocks = Blocks::diagonal(Vector3::zeros(), Vector3::zeros());
        for i in 0..R {
            for j in 0..R {
                if W::ANSWERS[i][j] {
                    let by_velocity = by_velocity[j] * impedance[(i, j)];
                    let by_turning = by_turning[j] * impedance[(i, j)];
                    blocks.a += outer(&self.by_velocity[i], &by_velocity);
                    blocks.b += outer(&self.by_velocity[i], &by_turning);
                    blocks.c += outer(&self.by_turning[i], &by_velocity);
                    blocks.d += outer(&self.by_turning[i], &by_turning);
                }
            }
        }
        blocks
    }
}

/// What sees speeds of one body and has no place.
trait Sees<const R: usize> {
    /// Of what it is made.
    type Number: Scalar;

    /// The body.
    fn body(&self) -> usize;

    /// What there is to see of it where it is `at` a pose and motion.
    fn speeds(&self, at: &PlacedBody<Self::Number>) -> Speeds<Self::Number, R>;

    /// How the torque of a `force` that is held, and keeps its direction in the frame, goes by a small turn of the body.
    fn carried(&self, at: &PlacedBody<Self::Number>, force: &SVector<Self::Number, R>) -> Matrix3<Self::Number>;
}

/// How the speed of a point at the `lever` (m, in the body's axes) along an axis of the frame changes with the angular velocity, and with a
/// small turn of the body: ω·(lever × axis), the axis turning against the body, ∂axis = axis × θ.
#[inline(always)]
fn at_lever<S: Scalar>(at: &PlacedBody<S>, (lever, axis): (&Vector3<S>, &Vector3<S>)) -> [Vector3<S>; 2] {
    let lever = times(&at.to_frame, lever);
    [cross(&lever, axis), cross(axis, &cross(&lever, &at.rotation_w))]
}

/// How the torque of a `force` (N) at the `lever` along an axis of the frame changes with a small turn of the body.
#[inline(always)]
fn carried_at<S: Scalar>(at: &PlacedBody<S>, (lever, axis): (&Vector3<S>, &Vector3<S>), force: S) -> Matrix3<S> {
    twice_crossed(&outer(&(axis * force), &times(&at.to_frame, lever)))
}

impl<S: Scalar> Sees<1> for AtPoint<S> {
    type Number = S;

    #[inline(always)]
    fn body(&self) -> usize {
        self.body
    }

    #[inline(always)]
    fn speeds(&self, at: &PlacedBody<S>) -> Speeds<S, 1> {
        let [by_turning, by_turn] = at_lever(at, (&self.lever, &self.axis_w));
        Speeds::new(at, [[self.axis_w], [by_turning], [by_turn]])
    }

    #[inline(always)]
    fn carried(&self, at: &PlacedBody<S>, force: &SVector<S, 1>) -> Matrix3<S> {
        carried_at(at, (&self.lever, &self.axis_w), force[0])
    }
}

impl<S: Scalar> Sees<2> for Along<S> {
    type Number = S;

    #[inline(always)]
    fn body(&self) -> usize {
        self.body
    }

    #[inline(always)]
    fn speeds(&self, at: &PlacedBody<S>) -> Speeds<S, 2> {
        let ([by_turning, by_turn], none) = (at_lever(at, (&self.lever, &self.axis_w)), Vector3::zeros());
        Speeds::new(at, [[self.axis_w; 2], [by_turning, none], [by_turn, none]])
    }

    #[inline(always)]
    fn carried(&self, at: &PlacedBody<S>, force: &SVector<S, 2>) -> Matrix3<S> {
        carried_at(at, (&self.lever, &self.axis_w), force[0])
    }
}

impl<S: Scalar> Sees<1> for About<S> {
    type Number = S;

    #[inline(always)]
    fn body(&self) -> usize {
        self.body
    }

    #[inline(always)]
    fn speeds(&self, at: &PlacedBody<S>) -> Speeds<S, 1> {
        // ω·axis with ∂axis = axis × θ.
        Speeds::new(at, [[Vector3::zeros()], [self.axis_w], [cross(&at.rotation_w, &self.axis_w)]])
    }

    #[inline(always)]
    fn carried(&self, _: &PlacedBody<S>, force: &SVector<S, 1>) -> Matrix3<S> {
        cross_matrix(&(self.axis_w * force[0]))
    }
}

impl<S, L, const N: usize, const D: usize, const R: usize> Link<S, FreeBodies<S, N, D>, D, R> for L
where
    S: Scalar,
    L: Sees<R, Number = S>,
{
    type View = Speeds<S, R>;

    #[inline(always)]
    fn view(&self, _: &FreeBodies<S, N, D>, placed: &Placed<S, N>) -> Speeds<S, R> {
        self.speeds(&placed.body(self.body()))
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N>), view: &Speeds<S, R>) -> Seen<S, R> {
        Seen { place: SVector::zeros(), rate: view.rate }
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Speeds<S, R>,
        force: &SVector<S, R>,
        sum: &mut SVector<S, D>,
    ) {
        for ((by_velocity, by_turning), force) in view.by_velocity.iter().zip(&view.by_turning).zip(&force.data.0[0]) {
            add_wrench(sum, self.body(), [&(by_velocity * *force), &(by_turning * *force)]);
        }
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, R>>(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Speeds<S, R>,
        response: &Response<S, R>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let mut by_turning = view.by_turning;
        by_turning.iter_mut().zip(&view.by_turn).for_each(|(sum, by_turn)| *sum += by_turn * a);
        let mut blocks = view.blocks::<W>(&response.impedance, [&view.by_velocity, &by_turning]);
        blocks.d -= self.carried(&placed.body(self.body()), &response.force) * a;
        add_blocks(matrix, self.body(), &blocks);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, R>>(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Speeds<S, R>,
        response: &Response<S, R>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let by_motion = view.blocks::<W>(&response.impedance, [&view.by_velocity, &view.by_turning]);
        add_blocks(damping, self.body(), &by_motion);
        let mut by_place = view.blocks::<W>(&response.impedance, [&[Vector3::zeros(); R], &view.by_turn]);
        by_place.d -= self.carried(&placed.body(self.body()), &response.force);
        add_blocks(stiffness, self.body(), &by_place);
    }
}
