//! What a kernel's state consists of, number by number, so that it can be written down and read again.

use slipfit_core::{
    SVector,
    pose::{Orientation, Pose},
};

/// Something made of numbers.
pub trait Numbers {
    /// Shows `look` every number, always in the same order.
    fn each(&mut self, look: &mut impl FnMut(&mut f32));
}

impl Numbers for f32 {
    fn each(&mut self, look: &mut impl FnMut(&mut f32)) {
        look(self);
    }
}

impl Numbers for () {
    fn each(&mut self, _: &mut impl FnMut(&mut f32)) {}
}

impl<A: Numbers, B: Numbers> Numbers for (A, B) {
    fn each(&mut self, look: &mut impl FnMut(&mut f32)) {
        self.0.each(look);
        self.1.each(look);
    }
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    fn each(&mut self, look: &mut impl FnMut(&mut f32)) {
        self.iter_mut().for_each(|one| one.each(look));
    }
}

impl<const D: usize> Numbers for SVector<f32, D> {
    fn each(&mut self, look: &mut impl FnMut(&mut f32)) {
        self.iter_mut().for_each(look);
    }
}

impl Numbers for Pose<f32> {
    fn each(&mut self, look: &mut impl FnMut(&mut f32)) {
        let Self { displacement_w, orientation: Orientation { w, v } } = self;
        displacement_w.iter_mut().for_each(&mut *look);
        look(w);
        v.iter_mut().for_each(look);
    }
}
