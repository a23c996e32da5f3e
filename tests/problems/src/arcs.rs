//! A command there and back whose bits are the same in every language: arcs of parabolas.

/// The command in a `period`: from −`amplitude` to `amplitude` and back in `every` periods.
pub fn arcs(amplitude: f32, period: u32, every: u32) -> f32 {
    let x = 2.0 * (period % every) as f32 / every as f32;
    let (amplitude, x) = if x < 1.0 { (amplitude, x) } else { (-amplitude, x - 1.0) };
    amplitude * 4.0 * x * (1.0 - x)
}
