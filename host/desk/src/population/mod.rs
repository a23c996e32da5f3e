//! Many slides at a time: each unit of a population on a lane of the machine's registers.

mod cube_root;
mod figures;
mod integrate;
mod lane;
mod passed_over;

use pulp::{Simd, WithSimd};
use slipfit_core::menu::SlideData;

pub use figures::Figures;
pub use integrate::Course;
use integrate::integrate;

use crate::{laws, out_of_line::OutOfLine, pack::Pack};

/// The slides of some units, all of the same laws.
#[derive(Clone, Copy)]
struct Work<'a> {
    course: Course,
    slides: &'a [SlideData<f64>],
}

/// As many at a time as a register of the instructions holds.
impl WithSimd for Work<'_> {
    type Output = Vec<Figures>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, instructions: V) -> Vec<Figures> {
        let Self { course, slides } = self;
        let mut figures = vec![Figures::NONE; slides.len()];
        if slides.first().and_then(laws::usual).is_some() {
            integrate(instructions, &course, slides, &mut figures, laws::usual::<Pack<V>>);
        } else {
            integrate(instructions, &course, slides, &mut figures, laws::chosen::<Pack<V>>);
        }
        figures
    }
}

/// Simulates `slides`, all of the same laws, in the widest instructions that the machine has. The bits do not depend on them.
/// A slide that cannot be simulated has no figures.
pub fn simulate(course: Course, slides: &[SlideData<f64>]) -> Vec<Figures> {
    simulate_in(usize::MAX, course, slides)
}

/// The same, as many at a time as the machine's registers have lanes, but at most `lanes`.
pub fn simulate_in(lanes: usize, course: Course, slides: &[SlideData<f64>]) -> Vec<Figures> {
    #[cfg(target_arch = "x86_64")]
    {
        let work = Work { course, slides };
        if let Some(avx512) = pulp::x86::V4::try_new().filter(|_| lanes >= 16) {
            return Simd::vectorize(avx512, work);
        }
        if let Some(avx2) = pulp::x86::V3::try_new().filter(|_| lanes >= 8) {
            return Simd::vectorize(avx2, work);
        }
    }
    one_by_one(course, slides)
}

/// The same, one after the other.
fn one_by_one(course: Course, slides: &[SlideData<f64>]) -> Vec<Figures> {
    let mut figures = vec![Figures::NONE; slides.len()];
    // In one function with their loop the forces would take long to compile.
    if slides.first().and_then(laws::usual).is_some() {
        let load = |data: &_| laws::usual::<Pack<pulp::Scalar>>(data).map(OutOfLine::new);
        integrate(pulp::Scalar, &course, slides, &mut figures, load);
    } else {
        let load = |data: &_| laws::chosen::<Pack<pulp::Scalar>>(data).map(OutOfLine::new);
        integrate(pulp::Scalar, &course, slides, &mut figures, load);
    }
    figures
}
