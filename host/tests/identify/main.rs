//! `slipfit identify`: records of known motion give their parameters back, and bad ones are refused.

#[path = "../common/mod.rs"]
mod common;
mod drive_train;
mod mechanism;
mod production;
mod refused;
mod slide;

use std::path::Path;

use slipfit_core::sampling::stream::unit_stream;
use slipfit_tolerance::failure::subset::normals;

/// A drive of 2 kg with 5 N of Coulomb and 3 N·s/m of viscous friction that swings to and fro: time, speed and force.
fn swinging() -> String {
    let noise = normals(&mut unit_stream(1, 0), 3000);
    let row = |i: usize| {
        let t = 1e-3 * i as f64;
        let (speed, acceleration) = (libm::sin(8.0 * t), 8.0 * libm::cos(8.0 * t));
        format!("{t},{},{}\n", 1e3 * speed, 2.0 * acceleration + 3.0 * speed + 5.0 * speed.signum() + 0.1 * noise[i])
    };
    (0..3000).fold("t (s),speed (mm/s),force (N)\n".to_owned(), |text, i| text + &row(i))
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

const TRAIN: &str = "[identify]\nmodel = \"drive-train\"\n";
