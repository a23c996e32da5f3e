//! The hash that ties a table and a kernel to the mechanism that they were made of.

use super::{
    Action, Gap, Joint, JointKind, Laws, Mechanism, NormalData, Port, Sampling, SlidingData, SpringKind, Thrown, Walls,
};
use crate::setup::Digest;
use slipfit_core::{
    drive::{Drive, TrainData},
    law::StribeckData,
    menu::FrictionData,
};

/// The physics of every unit, and which drive a table is of. Titles and names, what is simulated and how a controller
/// computes count for nothing.
pub fn hash(mechanism: &Mechanism, drive: usize) -> u64 {
    let mut digest = Digest::new();
    digest.bytes(b"mechanism");
    digest.counts([usize::from(mechanism.planar), mechanism.bodies.len(), mechanism.joints.len()]);
    digest.counts([mechanism.springs.len(), mechanism.drives.len(), mechanism.gaps.len(), drive]);
    digest.numbers(mechanism.gravity);
    for body in &mechanism.bodies {
        digest.numbers([body.mass, body.start.angle, body.start.spin, body.start.speed]);
        digest.numbers(body.inertia.into_iter().chain(body.centre));
        if let Some(Thrown { displacement, turned, velocity, spin }) = body.start.thrown {
            digest.numbers([displacement, turned, velocity, spin].into_iter().flatten());
        }
    }
    for joint in &mechanism.joints {
        of_joint(&mut digest, joint);
    }
    for spring in &mechanism.springs {
        digest.counts(spring.between.map(port));
        digest.numbers([spring.stiffness, spring.damping]);
        match spring.kind {
            // Relaxed in the drawn pose, as every spring was that older tables know.
            SpringKind::Torsion { rest: 0.0 } => {}
            SpringKind::Torsion { rest } => digest.numbers([rest]),
            SpringKind::Line { ends, free_length } => {
                digest.numbers(ends.into_iter().flatten().chain([free_length]));
            }
        }
    }
    for named in &mechanism.drives {
        let Drive { gain, ramp_start, ramp_end, speed, point_b } = named.drive;
        let (kind, axis) = match named.action {
            Action::Pushes { axis } => (0, axis),
            Action::Turns { axis } => (1, axis),
        };
        digest.counts([named.body, kind]);
        digest.numbers([gain, ramp_start, ramp_end, speed].into_iter().chain(axis));
        digest.numbers(point_b.iter().copied());
        if let Some(command) = &named.command {
            let pieces = &command.pieces.0;
            digest.counts([pieces.len()]);
            digest.numbers(pieces.iter().flat_map(|piece| piece.coefficients.into_iter().chain([piece.start])));
        }
        if let Some(Sampling { period, position_gain, differentiates, positions, .. }) = &named.sampling {
            digest.counts([usize::from(position_gain.is_some()), usize::from(*differentiates)]);
            digest.numbers([*period, position_gain.unwrap_or_default()]);
            digest.numbers(positions.iter().flat_map(|positions| positions.iter().copied()));
        }
        if let Some(train) = &named.train {
            of_train(&mut digest, train);
        }
        if !named.at_centre && named.drive.point_b.iter().any(|of| *of != 0.0) {
            digest.bytes(b"at its point");
        }
        if named.rotor != 0.0 {
            digest.numbers([named.rotor]);
        }
    }
    for Gap { statistics, .. } in &mechanism.gaps {
        digest.numbers([statistics.mean, statistics.deviation]);
    }
    digest.finish()
}

/// A body by its number, the frame by 0.
fn port(port: Port) -> usize {
    port.map_or(0, |body| body + 1)
}

fn of_joint(digest: &mut Digest, Joint { between, at, kind, laws, walls, drag, .. }: &Joint) {
    digest.counts(between.map(port));
    digest.numbers(*at);
    match kind {
        JointKind::Fixed => digest.counts([0]),
        // The normal of a plane is none to be told.
        JointKind::Revolute { axis: [0.0, 0.0, 1.0] } => digest.counts([1]),
        JointKind::Revolute { axis } => with(digest, [1], *axis),
        JointKind::Prismatic { axis } => with(digest, [2], *axis),
        JointKind::PinSlot { axis } => with(digest, [3], *axis),
        JointKind::Journal { gap, radius } => with(digest, [4, *gap], [*radius]),
        JointKind::Guide { gap, axis, edges } => with(digest, [5, *gap], axis.iter().chain(edges).copied()),
        JointKind::Bearing { gap, axis, length, radius } => {
            with(digest, [6, *gap], axis.iter().copied().chain([*length, *radius]));
        }
        JointKind::Track { gaps } => {
            digest.counts([7]);
            digest.counts(gaps.map(|gap| gap.map_or(0, |gap| gap + 1)));
        }
        JointKind::Stop { gap, normal } => with(digest, [8, *gap], *normal),
        JointKind::Cylindrical { axis } => with(digest, [9], *axis),
        JointKind::Spherical => digest.counts([10]),
    }
    if !kind.is_ideal() {
        of_laws(digest, laws);
    }
    match walls {
        Walls::Parallel => {}
        Walls::Stated(contours) => {
            digest.numbers(contours.iter().flat_map(|contour| [contour.slope, contour.curvature]));
        }
        Walls::OfGaps(walls) => walls.iter().for_each(|wall| {
            digest.counts(wall.iter().map(|of| of.gap));
            digest.numbers(wall.iter().flat_map(|of| of.adds));
        }),
    }
    if let Some(drag) = drag {
        of_train(digest, drag);
    }
}

fn of_train(digest: &mut Digest, train: &TrainData<f64>) {
    let TrainData { limit, coulomb: [along, against], stick_band, viscous, offset } = *train;
    digest.numbers([limit, along, against, stick_band, viscous, offset]);
}

fn of_laws(digest: &mut Digest, Laws { contact, friction }: &Laws) {
    match contact {
        NormalData::Impact(of) => with(digest, [0], [of.stiffness, of.exponent, of.damping, of.depth]),
        NormalData::HuntCrossley(of) => with(digest, [1], [of.stiffness, of.exponent, of.restitution, of.speed]),
        NormalData::LankaraniNikravesh(of) => with(digest, [2], [of.stiffness, of.exponent, of.restitution, of.speed]),
    }
    match friction {
        SlidingData::Coulomb(FrictionData::None) => digest.counts([0]),
        SlidingData::Coulomb(FrictionData::Regularised { coefficient, stick_band }) => {
            with(digest, [1], [*coefficient, *stick_band]);
        }
        SlidingData::Coulomb(FrictionData::Exact { coefficient }) => with(digest, [2], [*coefficient]),
        SlidingData::Stribeck(StribeckData { at_rest, kinetic, stribeck_speed, viscous, stick_band }) => {
            with(digest, [3], [*at_rest, *kinetic, *stribeck_speed, *viscous, *stick_band]);
        }
        SlidingData::StaticKinetic { at_rest, kinetic } => with(digest, [4], [*at_rest, *kinetic]),
    }
}

fn with(digest: &mut Digest, counts: impl IntoIterator<Item = usize>, numbers: impl IntoIterator<Item = f64>) {
    digest.counts(counts);
    digest.numbers(numbers);
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, SceneFile, shipped};

    fn hash(scene: &str, set: &[&str]) -> u64 {
        let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
        let file = SceneFile::parse(scene, shipped(scene).unwrap(), &set).unwrap_or_else(|error| panic!("{error}"));
        super::hash(&file.mechanism.unwrap(), 0)
    }

    #[test]
    fn sees_what_changes_the_physics() {
        let changes = [
            "mechanism.gravity=[0, -9.8]",
            "body.rod.mass=211",
            "body.rod.centre=[111, 0]",
            "body.crank.spin=1",
            "joint.big end.clearance=[0.2, 0.03]",
            "joint.big end.radius=9",
            "contact.stiffness=1.1e8 N/m^1.5",
            "contact.damping=100 N·s/m",
            "friction.coefficient=0.2",
            "friction.law=none",
            "drive.motor.gain=0.3",
            "drive.motor.speed=31",
            "drive.motor.ramp_end=0.2",
        ];
        let mut hashes: Vec<_> = changes.iter().map(|change| hash("slider-crank", &[change])).collect();
        hashes.push(hash("slider-crank", &[]));
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), changes.len() + 1);
    }

    #[test]
    fn does_not_see_what_does_not() {
        let same = ["title=other", "run.duration=100", "run.error=1e-6", "controller.step=50", "sweep.n=0:1:0.5"];
        for change in same {
            assert_eq!(hash("slider-crank", &[change]), hash("slider-crank", &[]), "{change}");
        }
    }
}
