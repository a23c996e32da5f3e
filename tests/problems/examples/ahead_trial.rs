//! Trial.
use slipfit_core::sampling::stream::Rng;
use slipfit_core::{
    ahead::{Ahead, Limits, State},
    integrator::{Integrator, Motion, Rodas3, Rodas4},
    kernel::Kernel,
    mechanism::Driven,
    menu::{FrictionData, SlideData},
    pose::Pose,
    sampling::{normal::score, stream::unit_stream},
    slide::CONTACTS,
};
use slipfit_problems::cd_rom::{self, CdRomSlide};

const N: usize = 128;

fn arg(name: &str, default: f64) -> f64 {
    std::env::args().find_map(|a| a.strip_prefix(&format!("{name}=")).and_then(|v| v.parse().ok())).unwrap_or(default)
}

/// Force at every ms by error control in f64.
fn converged(data: &SlideData<f64>, periods: usize, tolerance: f64) -> Vec<f64> {
    let slide: CdRomSlide<f64> = cd_rom::from_data(data);
    let kernel = Kernel::<f64, _, Rodas4>::new(slide, 1e-3).unwrap();
    let mut motion = kernel.at_rest(Pose::nominal()).motion;
    let (mut t, mut h) = (0.0f64, 1e-5);
    let mut out = vec![slide.drive().force(0.0, 0.0)];
    for k in 1..=periods {
        let end = k as f64 * 1e-3;
        loop {
            let last = t + h >= end - 1e-12;
            let length = if last { end - t } else { h };
            let step = Rodas4::step(&slide, t, length, &motion);
            let e = (slide.mass().recip() * step.error * 40.0 / tolerance)
                .max(step.drift / slide.mass() / (3e-5 * tolerance));
            let e = if e.is_finite() { e } else { 1e12 };
            let factor = (0.8 / e.max(1e-12).powf(0.25)).clamp(0.2, 3.0);
            let new = (length * factor).clamp(1e-12, 0.02);
            if e > 1.0 && length > 1e-11 {
                h = new;
                continue;
            }
            h = if last && new < h && e <= 1.0 { h.min(new * 3.0).max(new) } else { new };
            motion = step.motion;
            t = if last { end } else { t + length };
            if last {
                break;
            }
        }
        out.push(slide.drive().force(end, motion.velocity.z));
    }
    let _ = Motion { ..motion };
    out
}

fn cast(d: &SlideData<f64>) -> SlideData<f32> {
    d.cast(|x| x as f32)
}

struct Out {
    force: Vec<f64>,
    lead: Vec<f64>,
    attempts: usize,
    forced: u32,
    excess: f64,
    tol: f64,
}

fn ahead(data: &SlideData<f64>, periods: usize, limits: Limits<f32>, early: u32) -> Out {
    let slide: CdRomSlide<f32> = cd_rom::from_data(&cast(data));
    let ahead = Ahead::new(slide, limits).unwrap();
    let mut state: State<f32, _, 6, N> = ahead.at_rest(Pose::nominal(), early);
    let mut o = Out { force: vec![0.0], lead: vec![0.0], attempts: 0, forced: 0, excess: 0.0, tol: 0.0 };
    for p in 1..=(periods as u32 + early) {
        let got = ahead.step(&mut state);
        if p > early {
            o.force.push(got.force.into());
            o.lead.push(got.lead.into());
        }
        o.forced = got.forced;
        o.excess = got.excess.into();
        o.tol = o.tol.max(got.tolerance.into());
    }
    o
}

fn drawn(i: u64) -> SlideData<f64> {
    let mut random = unit_stream(1, i);
    let mut data = cd_rom::data(0.0f64);
    for (j, gap) in data.body.gaps.iter_mut().enumerate() {
        let [m, s] = cd_rom::TABLE_2[j];
        *gap = (m + s * score::<f64>(random.next_u64())) * 1e-3;
    }
    data
}

fn main() {
    let tol = arg("tol", 1e-4) as f32;
    let limits = Limits { period: 1e-3, tolerance: tol, lead: arg("lead", 0.06) as f32, lag: arg("lag", 0.2) as f32 };
    let early = arg("early", 70.0) as u32;
    let band = arg("band", 1e-4);
    let stiff = arg("stiff", 1.0);
    let ramp_end = arg("ramp", 1.0);
    let periods = arg("periods", 200.0) as usize;
    let units = arg("units", 100.0) as u64;
    if arg("refs", 0.0) > 0.0 {
        for (name, n, end, t1, vs) in [
            ("opening-n0", 0.0, 200, 1.0, 1e-4),
            ("opening-n1", 1.0, 200, 1.0, 1e-4),
            ("opening-n2.5", 2.5, 200, 1.0, 1e-4),
            ("opening-n5", 5.0, 200, 1.0, 1e-4),
            ("stroke-n0", 0.0, 1500, 1.0, 1e-4),
            ("stroke-n2.5", 2.5, 1500, 1.0, 1e-4),
            ("fast-n0", 0.0, 200, 0.1, 1e-4),
            ("fast-n2.5", 2.5, 200, 0.1, 1e-4),
            ("limit-n1", 1.0, 200, 1.0, band.min(1e-6)),
            ("limit-n2.5", 2.5, 200, 1.0, band.min(1e-6)),
        ] {
            let text = std::fs::read_to_string(format!("tests/reference/slide-{name}.csv")).unwrap();
            let reference: Vec<f64> =
                text.lines().skip(1).map(|l| l.split(',').nth(2).unwrap().parse().unwrap()).collect();
            let peak = reference.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            let mut data = cd_rom::data(n);
            data.drive.ramp_end = t1;
            data.friction = FrictionData::Regularised { coefficient: 0.3, stick_band: vs };
            let conv = converged(&data, end, 1e-8);
            let o = ahead(&data, end, limits, early);
            let err = |k: usize| (o.force[k] - reference[k]).abs() / peak * 100.0;
            let worst = (1..=end).filter(|k| o.lead[*k] >= 0.0).max_by(|a, b| err(*a).total_cmp(&err(*b))).unwrap();
            let conv_err = (1..=end).map(|k| (conv[k] - reference[k]).abs() / peak * 100.0).fold(0.0, f64::max);
            let behind = (1..=end).filter(|k| o.lead[*k] < 0.0).count();
            let late = (50..=end).filter(|k| o.lead[*k] < 0.0).count();
            let min = o.lead.iter().cloned().fold(1.0, f64::min);
            println!(
                "{name:14} err {:.4} % at {worst} ms; behind {behind} ({late} after 50ms), min lead {:.1} ms, forced {} excess {:.1e}; conv {:.5}",
                err(worst),
                min * 1e3,
                o.forced,
                o.excess,
                conv_err
            );
        }
        return;
    }
    let mut windows = [(0.0f64, 0u64); 4];
    let mut worst = Vec::new();
    let (mut late_units, mut leads) = (0, Vec::new());
    for i in 0..units {
        let mut data = drawn(i);
        data.contact.stiffness *= stiff;
        data.drive.ramp_end = ramp_end;
        data.friction = FrictionData::Regularised { coefficient: 0.3, stick_band: band };
        let o = ahead(&data, periods, limits, early);
        let min = o.lead.iter().cloned().fold(1.0, f64::min);
        let min_late = o.lead[50..].iter().cloned().fold(1.0, f64::min);
        leads.push(min_late);
        let behind = o.lead.iter().filter(|l| **l < 0.0).count();
        if min_late < 0.0 {
            late_units += 1;
        }
        let mut e = (0.0, 0);
        if arg("check", 1.0) > 0.0 {
            let conv = converged(&data, periods, arg("ctol", 1e-7));
            let peak = conv.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            for k in 1..=periods {
                if o.lead[k] >= 0.0 {
                    let x = (o.force[k] - conv[k]).abs() / peak * 100.0;
                    if x > e.0 {
                        e = (x, k);
                    }
                    let w = &mut windows[if k < 50 {
                        0
                    } else if k < 180 {
                        1
                    } else if k < 250 {
                        2
                    } else {
                        3
                    }];
                    if x > w.0 {
                        *w = (x, i * 10000 + k as u64);
                    }
                }
            }
        }
        if arg("show", -1.0) == i as f64 {
            let conv = converged(&data, periods, 1e-8);
            for k in 150..=200 {
                println!(
                    "{k} {:.6} {:.6} {:+.2e} lead {:.1}",
                    o.force[k],
                    conv[k],
                    o.force[k] - conv[k],
                    o.lead[k] * 1e3
                );
            }
            return;
        }
        worst.push((e.0, e.1, i, min * 1e3, min_late * 1e3, behind, o.forced, o.excess, o.attempts));
    }
    worst.sort_by(|a, b| b.0.total_cmp(&a.0));
    for w in worst.iter().take(8) {
        println!("{w:?}");
    }
    println!("windows {windows:?}");
    leads.sort_by(f64::total_cmp);
    worst.sort_by(|a, b| a.4.total_cmp(&b.4));
    println!("least leads:");
    for w in worst.iter().take(8) {
        println!("{w:?}");
    }
    println!(
        "late units {late_units}; lead after 50 ms: min {:.1} 1% {:.1} median {:.1} ms",
        leads[0] * 1e3,
        leads[leads.len() / 100] * 1e3,
        leads[leads.len() / 2] * 1e3
    );
}
