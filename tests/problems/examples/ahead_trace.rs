use slipfit_core::{
    integrator::{Integrator, Rodas3},
    kernel::Kernel,
    mechanism::Driven,
    pose::Pose,
    sampling::{
        normal::score,
        stream::{Rng, unit_stream},
    },
};
use slipfit_problems::cd_rom::{self, CdRomSlide};
fn main() {
    let i: u64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let tol: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let until: f64 = std::env::args().nth(3).unwrap().parse().unwrap();
    let mut random = unit_stream(1, i);
    let mut data = cd_rom::data(0.0f64);
    for (j, gap) in data.body.gaps.iter_mut().enumerate() {
        let [m, s] = cd_rom::TABLE_2[j];
        *gap = (m + s * score::<f64>(random.next_u64())) * 1e-3;
    }
    fn go<S: slipfit_core::Scalar + PartialOrd>(
        data: &slipfit_core::menu::SlideData<S>,
        tol: f64,
        until: f64,
        show: bool,
    ) {
        let slide: CdRomSlide<S> = cd_rom::from_data(data);
        let mut motion = Kernel::<S, _, Rodas3>::new(slide, S::from_f64(1e-3)).unwrap().at_rest(Pose::nominal()).motion;
        let (mut t, mut h, mut tried, mut refused, mut by_place) = (0.0f64, 2e-5f64, 0, 0, 0);
        while t < until && tried < 5000 {
            let step = Rodas3::step(&slide, S::from_f64(t), S::from_f64(h), &motion);
            let f = step.error.to_f64() * 40.0 / 0.0818 / tol;
            let p = step.drift.to_f64() / 0.0818 / (2e-5 * tol);
            let e = f.max(p);
            let ok = e <= 1.0;
            tried += 1;
            if p > f {
                by_place += 1;
            }
            if show {
                println!(
                    "{tried:4} t {:9.4} ms h {:9.2} us force {f:8.3} place {p:8.3} {} vz {:e}",
                    t * 1e3,
                    h * 1e6,
                    if ok { "" } else { "REFUSED" },
                    motion.velocity.z.to_f64()
                );
            }
            if ok {
                t += h;
                motion = step.motion;
                if t > 0.185 {
                    let d: slipfit_core::menu::SlideData<f64> = data.cast(|x: S| x.to_f64());
                    let s64: CdRomSlide<f64> = cd_rom::from_data(&d);
                    let mut m = Kernel::<f64, _, Rodas3>::new(s64, 1e-3).unwrap().at_rest(Pose::nominal()).motion;
                    let (mut tt, mut hh) = (0.0f64, 1e-6f64);
                    while tt < t {
                        let l = hh.min(t - tt);
                        let st = slipfit_core::integrator::Rodas4::step(&s64, tt, l, &m);
                        let e = (st.error * 40.0 / 0.0818 / 1e-8).max(st.drift / 0.0818 / 3e-13);
                        if e <= 1.0 {
                            tt += l;
                            m = st.motion;
                        }
                        hh = l * (0.8 / e.max(1e-9).powf(0.25)).clamp(0.2, 3.0);
                        if tt + 1e-13 > t {
                            break;
                        }
                    }
                    println!(
                        "knot {:9.4} ms h {:8.1} us force err {:+.2e} est {:.2e}",
                        t * 1e3,
                        h * 1e6,
                        40.0 * (motion.velocity.z.to_f64() - m.velocity.z),
                        f * tol
                    );
                }
            } else {
                refused += 1;
            }
            h = (h * (0.8 / e.max(1e-9).cbrt()).clamp(0.2, 3.0)).min(8e-3);
        }
        println!("unit: tried {tried} refused {refused} by place {by_place}");
    }
    let show = std::env::args().nth(4).is_some();
    go(&data, tol, until, false);
    go(&data.cast(|x: f64| x as f32), tol, until, show);
    let _ = |s: &CdRomSlide<f32>| s.mass();
}
