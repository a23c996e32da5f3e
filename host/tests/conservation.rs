//! Joints of two moving bodies, against the laws of conservation and against the same mechanism told in another order.

use nalgebra::{Matrix3, Rotation3, Vector3};
use slipfit::{
    mechanism::{Mechanism, MechanismRun, controller_run, run},
    scene::SceneFile,
};

/// Two bodies on a torsion spring or none, joined by `joint`, with the `rest` of the scene; `bodies` says in which order they are listed.
fn scene(space: &str, bodies: [char; 2], joint: &str, rest: &str) -> Mechanism {
    let body = |name: char| {
        let (mass, inertia, centre) = match (name, space) {
            ('a', "plane") => (400, "2e5".to_owned(), "[10, 5]"),
            (_, "plane") => (250, "9e4".to_owned(), "[60, 20]"),
            ('a', _) => (400, "[2e5, 3e5, 2.5e5]".to_owned(), "[10, 5, -8]"),
            _ => (250, "[9e4, 8e4, 1.2e5]".to_owned(), "[60, 20, 12]"),
        };
        format!("[[body]]\nname = \"{name}\"\nmass = {mass}\ninertia = {inertia}\ncentre = {centre}\n")
    };
    let text = format!(
        "title = \"Two bodies\"\n[mechanism]\nspace = \"{space}\"\n[run]\nduration = 200\nerror = 1e-7\n{}{}{joint}\n{rest}",
        body(bodies[0]),
        body(bodies[1]),
    );
    parsed(&text)
}

fn parsed(text: &str) -> Mechanism {
    let file = SceneFile::parse("test.toml", text, &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    file.mechanism.expect("a mechanism")
}

fn mean(mechanism: &Mechanism, every: f64) -> MechanismRun {
    run(mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), every).unwrap()
}

/// The column that begins with `name`.
fn column(run: &MechanismRun, name: &str) -> Vec<f64> {
    let found = run.samples.columns.iter().position(|column| column.starts_with(name));
    let k = found.unwrap_or_else(|| panic!("no {name} in {:?}", run.samples.columns));
    run.samples.rows.iter().map(|row| row[k]).collect()
}

/// The greatest difference of any column of the bodies, as a share of its greatest value.
fn apart(one: &MechanismRun, other: &MechanismRun) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for name in &one.samples.columns {
        let [one, other] = [one, other].map(|run| column(run, name));
        assert_eq!(one.len(), other.len());
        let most = one.iter().fold(1e-6, |most: f64, x| most.max(x.abs()));
        let difference = one.iter().zip(&other).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs())) / most;
        if difference > worst.0 {
            worst = (difference, name.clone());
        }
    }
    worst
}

const BODIES: [(char, f64); 2] = [('a', 0.4), ('b', 0.25)];

/// Linear and angular momentum (kg·m/s, kg·m²/s, about the origin) of both bodies at every sample.
fn momenta(mechanism: &Mechanism, run: &MechanismRun) -> Vec<[Vector3<f64>; 2]> {
    let vectors = |name: &str, axes: [&str; 3]| -> Vec<Vector3<f64>> {
        let columns =
            axes.map(|axis| if axis.is_empty() { Vec::new() } else { column(run, &format!("{name}.{axis}")) });
        let part = |k: usize, i: usize| columns[k].get(i).copied().unwrap_or(0.0);
        (0..run.samples.rows.len()).map(|i| Vector3::new(part(0, i), part(1, i), part(2, i))).collect()
    };
    let mut sums = vec![[Vector3::zeros(); 2]; run.samples.rows.len()];
    for (name, mass) in BODIES {
        let name = name.to_string();
        let body = mechanism.bodies.iter().find(|body| body.name == name).unwrap();
        let planar = mechanism.planar;
        let places = vectors(&name, if planar { ["x (m)", "y (m)", ""] } else { ["x (m)", "y (m)", "z (m)"] });
        let turns = vectors(&name, if planar { ["", "", "angle"] } else { ["ax", "ay", "az"] });
        let velocities = vectors(&name, if planar { ["vx", "vy", ""] } else { ["vx", "vy", "vz"] });
        let spins = vectors(&name, if planar { ["", "", "spin"] } else { ["wx", "wy", "wz"] });
        for (i, sum) in sums.iter_mut().enumerate() {
            let rotation = Rotation3::new(turns[i]);
            let inertia = rotation * Matrix3::from_diagonal(&Vector3::from(body.inertia)) * rotation.inverse();
            let linear = velocities[i] * mass;
            sum[0] += linear;
            sum[1] += (Vector3::from(body.centre) + places[i]).cross(&linear) + inertia * spins[i];
        }
    }
    sums
}

/// A torque on one body and, in a plane, a push on the other at a point beside its centre.
const DRIVES: &str = "
[[drive]]
name = \"motor\"
turns = \"a\"
gain = 0.05
ramp_start = 0
ramp_end = 0.05
speed = 30
AXIS
[[drive]]
name = \"pusher\"
pushes = \"b\"
axis = PUSH
gain = \"4 N·s/m\"
ramp_start = 0
ramp_end = 0.06
speed = 300
point = POINT
";

fn drives(space: &str) -> String {
    let planar = space == "plane";
    DRIVES
        .replace("AXIS", if planar { "" } else { "axis = [0.6, 0, 0.8]" })
        .replace("PUSH", if planar { "[0.8, 0.6]" } else { "[0, 0.6, 0.8]" })
        .replace("POINT", if planar { "[5, -12]" } else { "[5, -12, 4]" })
}

/// What the drives have given of linear and of angular momentum since the start, at every sample: by the trapezoidal rule, of samples
/// that are `every` (s) apart.
fn given(mechanism: &Mechanism, run: &MechanismRun, every: f64) -> Vec<[Vector3<f64>; 2]> {
    let planar = mechanism.planar;
    let (about, along, point) = if planar {
        (Vector3::z(), Vector3::new(0.8, 0.6, 0.0), Vector3::new(0.005, -0.012, 0.0))
    } else {
        (Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 0.6, 0.8), Vector3::new(0.005, -0.012, 0.004))
    };
    let [torque, force] = ["motor", "pusher"].map(|name| column(run, name));
    let parts =
        |names: [&str; 3]| names.map(|name| if name.is_empty() { vec![0.0; torque.len()] } else { column(run, name) });
    let places = parts(if planar { ["b.x (m)", "b.y (m)", ""] } else { ["b.x (m)", "b.y (m)", "b.z (m)"] });
    let turns = parts(if planar { ["", "", "b.angle"] } else { ["b.ax", "b.ay", "b.az"] });
    let centre = mechanism.bodies.iter().find(|body| body.name == "b").unwrap().centre;
    let rates: Vec<[Vector3<f64>; 2]> = (0..torque.len())
        .map(|i| {
            let at = |of: &[Vec<f64>; 3]| Vector3::new(of[0][i], of[1][i], of[2][i]);
            let place = Vector3::from(centre) + at(&places) + Rotation3::new(at(&turns)) * point;
            let push = along * force[i];
            [push, about * torque[i] + place.cross(&push)]
        })
        .collect();
    let mut sum = [Vector3::zeros(); 2];
    let mut sums = vec![sum];
    for pair in rates.windows(2) {
        for (k, sum) in sum.iter_mut().enumerate() {
            *sum += (pair[0][k] + pair[1][k]) * (0.5 * every);
        }
        sums.push(sum);
    }
    sums
}

/// That momentum is what the drives have given, to a share of its greatest value.
fn check_momenta(mechanism: &Mechanism, run: &MechanismRun, every: f64, share: f64, what: &str) {
    let (found, given) = (momenta(mechanism, run), given(mechanism, run, every));
    for k in 0..2 {
        let most = given.iter().map(|all| all[k].norm()).fold(0.0, f64::max);
        let worst = found.iter().zip(&given).map(|(one, other)| (one[k] - other[k]).norm()).fold(0.0, f64::max);
        assert!(most > 1e-3 && worst < share * most, "{what}: momentum {k} errs by {worst:e} of {most:e}");
    }
}

/// Every ideal joint of two bodies that nothing else holds: whichever of them is listed first, and so carries the other, and whichever
/// stands first in `between` where both are alike, they move the same; momentum is what the drives have given.
#[test]
fn ideal_joints_do_not_care_which_body_carries_the_other() {
    let every = 1e-4;
    for (space, kinds) in [
        ("plane", &["fixed", "revolute", "prismatic", "pin-slot"][..]),
        ("space", &["fixed", "revolute", "prismatic", "cylindrical", "spherical"][..]),
    ] {
        for kind in kinds {
            // Two tracks of the same joint: of a pin-slot the second has the slot in the other body.
            let mut first_of_pair: Vec<MechanismRun> = Vec::new();
            for between in [["a", "b"], ["b", "a"]] {
                let axis = match (*kind, space) {
                    ("prismatic" | "pin-slot", "plane") => "axis = [0.6, 0.8]",
                    ("prismatic" | "cylindrical" | "revolute", "space") => "axis = [0.48, 0.64, 0.6]",
                    _ => "",
                };
                let at = if space == "plane" { "[40, 0]" } else { "[40, 0, 6]" };
                let joint = format!(
                    "[[joint]]\nname = \"joint\"\nkind = \"{kind}\"\nbetween = [\"{}\", \"{}\"]\nat = {at}\n{axis}",
                    between[0], between[1]
                );
                let runs = [['a', 'b'], ['b', 'a']].map(|bodies| {
                    let mechanism = scene(space, bodies, &joint, &drives(space));
                    let run = mean(&mechanism, every);
                    check_momenta(&mechanism, &run, every, 1e-5, &format!("{space} {kind} {between:?} {bodies:?}"));
                    run
                });
                let (worst, name) = apart(&runs[0], &runs[1]);
                assert!(worst < 1e-5, "{space} {kind} {between:?}: {name} differs by {worst:e}");
                let [run, _] = runs;
                first_of_pair.push(run);
            }
            let (worst, name) = apart(&first_of_pair[0], &first_of_pair[1]);
            if *kind == "pin-slot" {
                assert!(worst > 1e-2, "a slot of the other body is another mechanism");
            } else {
                assert!(worst < 1e-5, "{space} {kind}: {name} differs by {worst:e}");
            }
        }
    }
}

/// The same of joints with play, whose first and second body are not alike, so that only the listing may change; with friction.
#[test]
fn joints_with_play_do_not_care_which_body_is_listed_first() {
    let every = 2e-5;
    let laws = "
[contact]
stiffness = \"1e6 N/m^1.5\"
exponent = 1.5
damping = \"20 N·s/m\"
depth = 0.05
[friction]
law = \"regularised\"
coefficient = 0.2
stick_band = 5
";
    for (space, joint) in [
        ("plane", "kind = \"revolute\"\nat = [40, 0]\nclearance = [0.1, 0]\nradius = 4"),
        (
            "plane",
            "kind = \"prismatic\"\nat = [40, 0]\naxis = [0.6, 0.8]\nclearance = [0.1, 0]\nlength = 20\nwidth = 10",
        ),
        ("plane", "kind = \"stop\"\nat = [40, 0]\nnormal = [0.6, 0.8]\nclearance = [-0.05, 0]"),
        (
            "space",
            "kind = \"track\"\nat = [40, 0, 6]\nleft = [0.1, 0]\nright = [0.1, 0]\nrail = [0.1, 0]\nwall = [0.1, 0]",
        ),
        ("space", "kind = \"stop\"\nat = [40, 0, 6]\nnormal = [0, 1, 0]\nclearance = [-0.05, 0]"),
        (
            "space",
            "kind = \"cylindrical\"\nat = [40, 0, 6]\naxis = [0.6, 0, 0.8]\nclearance = [0.1, 0]\nlength = 20\nradius = 4",
        ),
    ] {
        for between in ["\"a\", \"b\"", "\"b\", \"a\""] {
            let joint = format!("[[joint]]\nname = \"joint\"\nbetween = [{between}]\n{joint}\n{laws}");
            let runs = [['a', 'b'], ['b', 'a']].map(|bodies| {
                let mut mechanism = scene(space, bodies, &joint, &drives(space));
                mechanism.run.duration = 0.06;
                let run = mean(&mechanism, every);
                // The trapezoidal rule meets the drives' forces, not their kinks where contacts close.
                check_momenta(&mechanism, &run, every, 1e-4, &format!("{space} {joint} {bodies:?}"));
                run
            });
            let (worst, name) = apart(&runs[0], &runs[1]);
            assert!(worst < 1e-3, "{joint}: {name} differs by {worst:e}");
        }
    }
}

/// A lever with a slot of its own on a pin of the frame, thrown about the pin: with r from the pin to its centre of mass (J + m·r²)·ω
/// and the energy are constant. At 10 rad/s it has 5.670 rad/s after 0.1 s.
#[test]
fn a_levers_own_slot_turns_with_the_lever() {
    let lever = |between: &str| {
        parsed(&format!(
            "title = \"Lever\"\n[mechanism]\nspace = \"plane\"\n[run]\nduration = 100\nerror = 1e-8\n\
             [[body]]\nname = \"lever\"\nmass = 100\ninertia = 1e5\ncentre = [50, 0]\nspin = 10\n\
             [[joint]]\nname = \"pin\"\nkind = \"pin-slot\"\nbetween = [{between}]\nat = [0, 0]\naxis = [1, 0]\n"
        ))
    };
    let run = mean(&lever("\"lever\", \"frame\""), 1e-3);
    let [x, y, spin, vx, vy] =
        ["lever.x", "lever.y", "lever.spin", "lever.vx", "lever.vy"].map(|name| column(&run, name));
    let (mass, inertia, start) = (0.1, 1e-4, 0.05);
    let energy = |i: usize| 0.5 * mass * (vx[i] * vx[i] + vy[i] * vy[i]) + 0.5 * inertia * spin[i] * spin[i];
    for i in 0..spin.len() {
        let r = libm::hypot(start + x[i], y[i]);
        let momentum = (inertia + mass * r * r) * spin[i];
        assert!((momentum / ((inertia + mass * start * start) * 10.0) - 1.0).abs() < 1e-6, "{i}: {momentum}");
        assert!((energy(i) / energy(0) - 1.0).abs() < 1e-6, "{i}");
    }
    assert!((spin[spin.len() - 1] - 5.670).abs() < 5e-4, "{}", spin[spin.len() - 1]);

    // In a slot of the frame nothing acts along the slot, and the energy is constant, too.
    let run = mean(&lever("\"frame\", \"lever\""), 1e-3);
    let [x, y, angle, spin, vx, vy] =
        ["lever.x", "lever.y", "lever.angle", "lever.spin", "lever.vx", "lever.vy"].map(|name| column(&run, name));
    let energy = |i: usize| 0.5 * mass * (vx[i] * vx[i] + vy[i] * vy[i]) + 0.5 * inertia * spin[i] * spin[i];
    for i in 0..spin.len() {
        assert!((y[i] - start * libm::sin(angle[i])).abs() < 1e-9 && vx[i].abs() < 1e-6 && x[i].abs() < 1e-7, "{i}");
        assert!((energy(i) / energy(0) - 1.0).abs() < 1e-6, "{i}");
    }
}

/// A slot in a turning crank and a slot in the block on it, both with a spring between the bodies: momentum about the crank's pivot and
/// energy stay. That of the crank's pivot would not if the slot turned with the wrong body.
#[test]
fn slots_between_two_moving_bodies_keep_momentum_and_energy() {
    for between in ["\"crank\", \"block\"", "\"block\", \"crank\""] {
        let mechanism = parsed(&format!(
            "title = \"Crank\"\n[mechanism]\nspace = \"plane\"\n[run]\nduration = 400\nerror = 1e-8\n\
             [[body]]\nname = \"crank\"\nmass = 300\ninertia = 3e5\ncentre = [20, 0]\nspin = 12\n\
             [[body]]\nname = \"block\"\nmass = 100\ninertia = 5e4\ncentre = [60, 10]\nspin = -25\nspeed = 100\n\
             [[joint]]\nname = \"pivot\"\nkind = \"revolute\"\nbetween = [\"crank\", \"frame\"]\nat = [0, 0]\n\
             [[joint]]\nname = \"slot\"\nkind = \"pin-slot\"\nbetween = [{between}]\nat = [50, 0]\naxis = [0.8, 0.6]\n\
             [[spring]]\nname = \"spring\"\nbetween = [\"block\", \"crank\"]\nstiffness = 0.05\n"
        ));
        let run = mean(&mechanism, 1e-3);
        let mut first = None;
        for i in 0..run.samples.rows.len() {
            let value = |name: &str| column(&run, name)[i];
            let (mut momentum, mut energy) = (0.0, 0.0);
            for (name, mass, inertia, centre) in [("crank", 0.3, 3e-4, [0.02, 0.0]), ("block", 0.1, 5e-5, [0.06, 0.01])]
            {
                let of = |what: &str| value(&format!("{name}.{what}"));
                let [x, y] = [centre[0] + of("x"), centre[1] + of("y")];
                let [vx, vy, spin] = [of("vx"), of("vy"), of("spin")];
                momentum += mass * (x * vy - y * vx) + inertia * spin;
                energy += 0.5 * mass * (vx * vx + vy * vy) + 0.5 * inertia * spin * spin;
            }
            let twist = value("block.angle") - value("crank.angle");
            energy += 0.5 * 0.05 * twist * twist;
            let [momentum_0, energy_0] = *first.get_or_insert([momentum, energy]);
            assert!((momentum - momentum_0).abs() < 1e-6 * 4e-3, "{between} {i}: {momentum} {momentum_0}");
            assert!((energy / energy_0 - 1.0).abs() < 1e-6, "{between} {i}: {energy} {energy_0}");
        }
        let [block, crank] = ["block.angle", "crank.angle"].map(|name| column(&run, name));
        let twist = block.iter().zip(&crank).map(|(block, crank)| (block - crank).abs());
        assert!(twist.fold(0.0, f64::max) > 0.5);
    }
}

/// A wheel on a torsion spring that winds it by three and a half turns, from anywhere: φ = start·cos ωt + spin/ω·sin ωt, by the desk and by
/// a controller's steps.
#[test]
fn a_torsion_spring_counts_its_turns() {
    for (start, spin) in [(0.0, 219.911_485_751_285_5), (540.0, 0.0), (180.0, 0.0), (-1260.0, 50.0), (179.0, 10.0)] {
        let text = format!(
            "title = \"Wheel\"\n[mechanism]\nspace = \"plane\"\n[run]\nduration = 700\nerror = 1e-7\n\
             [controller]\nstep = \"0.05 ms\"\nintegrator = \"sdirk2\"\n\
             [[body]]\nname = \"wheel\"\nmass = 100\ninertia = 1e5\ncentre = [0, 0]\nangle = {start}\nspin = {spin}\n\
             [[joint]]\nname = \"pivot\"\nkind = \"revolute\"\nbetween = [\"frame\", \"wheel\"]\nat = [0, 0]\n\
             [[spring]]\nname = \"spring\"\nbetween = BETWEEN\nstiffness = \"10 N·mm/rad\"\n"
        );
        for between in ["[\"wheel\", \"frame\"]", "[\"frame\", \"wheel\"]"] {
            let mechanism = parsed(&text.replace("BETWEEN", between));
            // 10 N·mm/rad on 1e-4 kg·m².
            let rate = 10.0;
            let start = f64::to_radians(start);
            for (by, run) in
                [("desk", mean(&mechanism, 1e-3)), ("controller", controller_run(&mechanism, &[], 1e-3).unwrap())]
            {
                let most = libm::hypot(start, spin / rate);
                for (i, angle) in column(&run, "wheel.angle").into_iter().enumerate() {
                    let t = 1e-3 * i as f64;
                    let expected = start * libm::cos(rate * t) + spin / rate * libm::sin(rate * t);
                    assert!(
                        (angle - expected).abs() < 1e-4 * most,
                        "{by} {between} {start} {spin} {t}: {angle} {expected}"
                    );
                }
            }
        }
    }
}

/// Turned on by a motor, a body goes on from turn to turn: in a bearing with play, on a ball, and on an axis, in both orders; its travel is
/// the angle that it has turned by, and the stroke ends it there.
#[test]
fn bodies_in_space_go_on_beyond_a_full_turn() {
    let laws = "[contact]\nstiffness = \"1e6 N/m^1.5\"\nexponent = 1.5\ndamping = \"20 N·s/m\"\ndepth = 0.05\n";
    for (joint, most_tilt) in [
        ("kind = \"spherical\"\nat = [0, 0, 0]", 1e-9),
        ("kind = \"revolute\"\naxis = [0, 0, 1]\nat = [0, 0, 0]", 1e-9),
        (
            "kind = \"cylindrical\"\naxis = [0, 0, 1]\nat = [0, 0, 0]\nclearance = [0.1, 0]\nlength = 50\nradius = 5",
            5e-3,
        ),
    ] {
        for (between, speed) in [("\"rotor\", \"frame\"", 40), ("\"frame\", \"rotor\"", -40)] {
            // What has no play has no contacts.
            let laws = if joint.contains("clearance") { laws } else { "" };
            let mechanism = parsed(&format!(
                "title = \"Rotor\"\n[mechanism]\nspace = \"space\"\n[run]\nduration = 1000\nstroke = 1000\nerror = 1e-6\n{laws}\
                 [[body]]\nname = \"rotor\"\nmass = 100\ninertia = [1e5, 1.1e5, 1.5e5]\ncentre = [0, 0, 0]\n\
                 [[joint]]\nname = \"joint\"\nbetween = [{between}]\n{joint}\n\
                 [[drive]]\nname = \"motor\"\nturns = \"rotor\"\naxis = [0, 0, 1]\ngain = 0.1\nramp_start = 0\nramp_end = 0.02\nspeed = {speed}\n"
            ));
            let run = mean(&mechanism, 1e-3);
            let outcome = run.outcomes[0];
            assert_eq!(outcome.stroke_reached, Some(true), "{joint}: {outcome:?}");
            assert!((outcome.end.z - f64::to_radians(1000.0)).abs() < 1e-6, "{joint}: {outcome:?}");
            let [ax, ay, az, wz] = ["ax", "ay", "az", "wz"].map(|name| column(&run, &format!("rotor.{name}")));
            let mut turned = 0.0;
            for i in 1..az.len() {
                turned += 0.5e-3 * (wz[i - 1] + wz[i]);
                assert!(libm::hypot(ax[i], ay[i]) <= most_tilt * 20.0, "{joint} {i}: {} {}", ax[i], ay[i]);
                assert!((az[i] - turned).abs() < 2e-3, "{joint} {between} {i}: {} {turned}", az[i]);
            }
            assert!(turned.abs() > 17.0, "{turned}");
        }
    }
}
