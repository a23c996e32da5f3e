//! Axes and points in their zones by every rule, against closed forms and a sampler of its own.

use slipfit_tolerance::{
    analysis::{analyse, theory},
    counting::study::Settings,
    sampling::sampler::Method,
    theory::experiment::{Design, experiment},
};

use super::tests::{close, product_of};

const RULES: [&str; 4] = ["sigma-zone", "truncated", "uniform-in-zone", "translation"];

/// Variance of one coordinate of a point in a disc of radius 1 by a rule: a normal of a third, cut at 1 if truncated.
fn in_disc(rule: &str) -> f64 {
    match rule {
        "truncated" => (1.0 - 4.5 * libm::exp(-4.5) / (1.0 - libm::exp(-4.5))) / 9.0,
        "uniform-in-zone" => 0.25,
        _ => 1.0 / 9.0,
    }
}

/// A bore of 20 mm, positioned within 0.1 mm to three perfect faces, seen from points beside its middle, its end, and as far
/// beyond the end as that is from the middle.
fn bore(rule: &str, callouts: &str) -> String {
    format!(
        r#"
[tolerance]
rule = "{rule}"
[[part]]
name = "plate"
plane = [
  {{ name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none" }},
  {{ name = "B", at = [-50, 0, 10], normal = "-x", along = "+y", extents = [100, 20], flatness = "none" }},
  {{ name = "C", at = [0, -50, 10], normal = "-y", along = "+x", extents = [100, 20], flatness = "none" }},
]
point = [
  {{ name = "middle", at = [-50, 0, 10], normal = "-x" }},
  {{ name = "end", at = [-50, 0, 20], normal = "-x" }},
  {{ name = "beyond", at = [-50, 0, 30], normal = "-x" }},
]
axis = [{{ name = "bore", at = [0, 0, 10], along = "+z", length = 20, {callouts} }}]
[[measure]]
name = "middle"
distance = ["plate.middle", "plate.bore"]
[[measure]]
name = "end"
distance = ["plate.end", "plate.bore"]
[[measure]]
name = "beyond"
distance = ["plate.beyond", "plate.bore"]
[[measure]]
name = "lean"
angle = ["plate.bore", "plate.A"]
"#
    )
}

const POSITION: &str = "position = { zone = 0.1, datum = [\"plate.A\", \"plate.B\", \"plate.C\"] }";

#[test]
fn a_position_zone_bounds_both_ends_of_its_axis() {
    for rule in RULES {
        let plate = product_of(&bore(rule, POSITION));
        let found = theory(&plate.model, 1, None).unwrap();
        // An end is off by place + tilt, the other by place − tilt; at a height of k half lengths the axis by place + k·tilt.
        let tilts = rule != "translation";
        for (i, k) in [0.0, 1.0, 2.0].into_iter().enumerate() {
            let parts = if tilts { [0.5 * (1.0 + k), 0.5 * (1.0 - k)] } else { [1.0, 0.0] };
            let deviation = 0.05 * libm::sqrt(in_disc(rule) * (parts[0] * parts[0] + parts[1] * parts[1]));
            // To first order: 50 mm away, the square of the lean adds a few millionths of the variance.
            close(found.moments[i].deviation * 1e3 / deviation, 1.0, 1e-4);
            let half = 0.05 * (parts[0].abs() + parts[1].abs());
            for (found, expected) in found.worst_cases[i].linear.into_iter().zip([50.0 - half, 50.0 + half]) {
                close(found * 1e3, expected, 1e-6);
            }
        }
        // It leans by the zone over its length.
        let [least, _] = found.worst_cases[3].linear;
        assert!(tilts || (least - std::f64::consts::PI).abs() < 1e-7, "{rule}");
    }
}

/// SplitMix64: numbers between −1 and 1 that the program has not made.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A point of the unit disc: uniform, or a normal of a third inside of it.
    fn in_disc(&mut self, normal: bool) -> [f64; 2] {
        loop {
            let [x, y] = [self.next(), self.next()];
            let square = x * x + y * y;
            if square > 1.0 {
                continue;
            }
            if !normal || 0.5 * (1.0 + self.next()) < libm::exp(-4.5 * square) {
                return [x, y];
            }
        }
    }
}

#[test]
fn units_of_a_tilting_axis_are_those_of_an_independent_sampler() {
    const UNITS: usize = 100_000;
    for (rule, normal) in [("truncated", true), ("uniform-in-zone", false)] {
        let mut numbers = Numbers(7);
        let mut values = vec![[0.0; 3]; UNITS];
        for unit in &mut values {
            // Both ends anywhere in the cylinder of 0.1 mm; distances from the line through them.
            let [low, high] = [0, 1].map(|_| numbers.in_disc(normal).map(|x| 0.05 * x));
            for (value, height) in unit.iter_mut().zip([10.0, 20.0, 30.0]) {
                let line = [high[0] - low[0], high[1] - low[1], 20.0];
                let apart = [-50.0 - low[0], -low[1], height];
                let cross = [0, 1, 2].map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    apart[j] * line[k] - apart[k] * line[j]
                });
                let length = |v: [f64; 3]| libm::sqrt(v.iter().map(|x| x * x).sum());
                *value = length(cross) / length(line);
            }
        }
        let plate = product_of(&bore(rule, POSITION));
        let settings = Settings { method: Method::PseudoRandom, samples: UNITS as u64, replicates: 1, seed: 1 };
        let found = analyse(&plate.model, settings, |_| ()).unwrap().joint;
        for i in 0..3 {
            let mean = values.iter().map(|unit| unit[i]).sum::<f64>() / UNITS as f64;
            let square = values.iter().map(|unit| (unit[i] - mean) * (unit[i] - mean)).sum::<f64>() / UNITS as f64;
            let sigma = libm::sqrt(square);
            let measure = &found.measures[i];
            // Both samples have the same standard errors.
            let of_mean = measure.mean.error.unwrap() * 1e3 * std::f64::consts::SQRT_2;
            let of_sigma = measure.deviation.error.unwrap() * 1e3 * std::f64::consts::SQRT_2;
            assert!((measure.mean.value * 1e3 - mean).abs() < 4.0 * of_mean, "{rule} {i}: {:?} {mean}", measure.mean);
            assert!(
                (measure.deviation.value * 1e3 - sigma).abs() < 4.0 * of_sigma,
                "{rule} {i}: {:?} {sigma}",
                measure.deviation
            );
        }
    }
}

/// A refinement narrows the tilts, and one that is as wide as the position changes nothing.
#[test]
fn an_orientation_beside_a_position_narrows_its_tilts() {
    let of = |callouts: &str| theory(&product_of(&bore("sigma-zone", callouts)).model, 1, None).unwrap();
    let alone = of(POSITION);
    let wide = of(&format!("{POSITION}, perpendicularity = {{ zone = 0.1, datum = \"plate.A\" }}"));
    let narrow = of(&format!("{POSITION}, perpendicularity = {{ zone = 0.02, datum = \"plate.A\" }}"));
    for i in 0..3 {
        close(wide.moments[i].deviation / alone.moments[i].deviation, 1.0, 1e-9);
        for (wide, alone) in wide.worst_cases[i].linear.into_iter().zip(alone.worst_cases[i].linear) {
            close(wide, alone, 1e-12);
        }
    }
    // The end keeps its sixth of the zone and its limits; beyond it there is a fifth of the tilt.
    close(narrow.moments[1].deviation * 1e3, 0.1 / 6.0, 1e-6);
    close(narrow.worst_cases[1].linear[1] * 1e3, 50.05, 1e-7);
    close(narrow.worst_cases[2].linear[1] * 1e3, 50.05 + 0.01, 1e-7);
}

/// A concentricity is of the middle, and an axis between two planes shifts along their normal.
#[test]
fn sections_do_not_tilt() {
    let own = "concentricity = { zone = 0.1, datum = \"plate.D\" }";
    let text = bore("sigma-zone", own)
        .replace("axis = [", "axis = [{ name = \"D\", at = [0, 0, 40], along = \"+z\", length = 20 }, ");
    let found = theory(&product_of(&text).model, 1, None).unwrap();
    for i in 0..3 {
        close(found.moments[i].deviation * 1e3, 0.1 / 6.0, 1e-6);
    }
}

/// A point in a zone of 0.06 mm, whose σ (mm) the rule decides.
#[test]
fn points_obey_the_rule_of_their_zone() {
    // A normal of a sixth cut at three standard deviations keeps 1 − 6·φ(3)/(2·Φ(3) − 1) of its variance.
    let cut = libm::sqrt(1.0 - 6.0 * 0.004_431_848_411_938_008 / 0.997_300_203_936_739_8);
    for (rule, deviation) in RULES.into_iter().zip([0.01, 0.01 * cut, 0.06 / libm::sqrt(12.0), 0.01]) {
        for (scene, callout) in [
            (rule, "profile = 0.06".to_owned()),
            (rule, "flatness = 0.06".into()),
            (rule, "position = { zone = 0.06, datum = \"base.top\" }".into()),
            ("sigma-zone", format!("profile = {{ zone = 0.06, rule = \"{rule}\" }}")),
            ("truncated", format!("flatness = {{ zone = 0.06, rule = \"{rule}\" }}")),
            // ISO 2768-2 L: 0.4 mm for 60 mm, and a sixth or so of that.
            (rule, "extents = [60, 40]".into()),
        ] {
            let general = if callout.starts_with("extents") { "general = \"L\"" } else { "" };
            let width = if callout.starts_with("extents") { 0.4 } else { 0.06 };
            let product = product_of(&format!(
                "[tolerance]\nrule = \"{scene}\"\n{general}\n[[part]]\nname = \"base\"\n\
                 plane = [{{ name = \"top\", at = [0, 0, 0], normal = \"+z\", along = \"+x\", extents = [9, 9], flatness = \"none\" }}]\n\
                 point = [{{ name = \"tip\", at = [0, 0, 5], normal = \"+z\", {callout} }}]\n\
                 [[measure]]\nname = \"m\"\ndistance = [\"base.tip\", \"base.top\"]\n"
            ));
            let found = theory(&product.model, 1, None).unwrap();
            close(found.moments[0].deviation * 1e3 / (deviation * width / 0.06), 1.0, 1e-6);
            for (found, sign) in found.worst_cases[0].linear.into_iter().zip([-1.0, 1.0]) {
                close(found * 1e3, 5.0 + sign * 0.5 * width, 1e-9);
            }
            let settings = Settings { method: Method::PseudoRandom, samples: 20_000, replicates: 1, seed: 1 };
            let drawn = &analyse(&product.model, settings, |_| ()).unwrap().joint.measures[0];
            assert!(
                (drawn.deviation.value - found.moments[0].deviation).abs() < 4.0 * drawn.deviation.error.unwrap(),
                "{rule} {callout}: {:?}",
                drawn.deviation
            );
        }
    }
}

/// The same of the axis of a bolt between two faces.
#[test]
fn an_axis_between_planes_obeys_the_rule_of_its_zone() {
    for (rule, deviation) in RULES.into_iter().zip([0.02, 0.02 * 0.986_578, 0.12 / libm::sqrt(12.0), 0.02]) {
        let product = product_of(&format!(
            r#"
[tolerance]
rule = "{rule}"
[[part]]
name = "fork"
plane = [{{ name = "middle", at = [0, 0, 0], normal = "+y", along = "+x", extents = [40, 40], flatness = "none" }}]
axis = [{{ name = "bolt", at = [10, 0, 0], along = "+z", length = 20, symmetry = {{ zone = 0.12, datum = "fork.middle" }} }}]
[[measure]]
name = "off"
distance = ["fork.bolt", "fork.middle"]
"#
        ));
        let found = theory(&product.model, 1, None).unwrap();
        close(found.moments[0].deviation * 1e3 / deviation, 1.0, 1e-5);
    }
}

/// Factors of an experiment are the place and the tilts of the axis; none of both is dropped.
#[test]
fn designed_experiments_keep_shifts() {
    let plate = product_of(&bore("sigma-zone", POSITION));
    let found = experiment(&plate.model, Design::FullFactorial).unwrap();
    assert_eq!(found.runs, 16);
    // Place and tilt each at half of the zone's radius along a diagonal: ± 0.05/(2·√2) along x.
    let step = 2.0 * 0.05 / (2.0 * std::f64::consts::SQRT_2);
    for (measure, shares) in [(0, [1.0, 0.0]), (1, [1.0, 1.0]), (2, [1.0, 2.0])] {
        let effects = &found.findings[measure].effects;
        for (part, share) in effects.chunks(2).zip(shares) {
            let along: f64 = part.iter().map(|effect| effect * effect).sum();
            close(libm::sqrt(along) * 1e3, share * step, 1e-6);
        }
    }
    // No corner leaves the zone, and some reach it.
    let [least, greatest] = found.findings[1].range.map(|x| x * 1e3);
    close(least, 50.0 - step, 1e-4);
    close(greatest, 50.0 + step, 1e-4);
}
