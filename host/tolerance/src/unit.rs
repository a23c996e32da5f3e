//! Units of scene files: the one conversion to SI.

/// A unit as `times / per` of the SI unit: of the two, one is 1, so that a decimal is rounded only once.
#[derive(Clone, Copy)]
pub struct Unit {
    /// Its symbol.
    pub symbol: &'static str,
    times: f64,
    per: f64,
}

const fn si(symbol: &'static str) -> Unit {
    Unit { symbol, times: 1.0, per: 1.0 }
}

const fn times(symbol: &'static str, times: f64) -> Unit {
    Unit { symbol, times, per: 1.0 }
}

const fn per(symbol: &'static str, per: f64) -> Unit {
    Unit { symbol, times: 1.0, per }
}

const MILLISECOND: Unit = per("ms", 1e3);
const MICROSECOND: Unit = per("µs", 1e6);

/// A plain number.
pub const ONE: &[Unit] = &[si("")];
/// Lengths.
pub const LENGTH: &[Unit] =
    &[per("mm", 1e3), si("m"), per("cm", 1e2), per("µm", 1e6), per("nm", 1e9), times("in", 0.0254)];
/// Angles.
pub const ANGLE: &[Unit] = &[times("°", std::f64::consts::PI / 180.0), si("rad"), per("mrad", 1e3)];
/// Masses.
pub const MASS: &[Unit] = &[per("g", 1e3), si("kg"), per("mg", 1e6)];
/// Forces.
pub const FORCE: &[Unit] = &[si("N"), per("mN", 1e3), times("kN", 1e3)];
/// Frequencies.
pub const FREQUENCY: &[Unit] = &[si("Hz"), times("kHz", 1e3)];
/// Gain of a position loop: speed for each unit of distance.
pub const PER_SECOND: &[Unit] = &[si("1/s")];
/// Electric currents.
pub const CURRENT: &[Unit] = &[si("A"), per("mA", 1e3)];
/// Voltages.
pub const VOLTAGE: &[Unit] = &[si("V"), per("mV", 1e3)];
/// Stiffnesses.
pub const STIFFNESS: &[Unit] = &[times("N/mm", 1e3), si("N/m"), times("N/µm", 1e6)];
/// Moments of a force.
pub const MOMENT: &[Unit] = &[per("N·mm", 1e3), si("N·m")];
/// Pressures and stresses.
pub const PRESSURE: &[Unit] = &[times("MPa", 1e6), si("Pa"), times("kPa", 1e3), times("GPa", 1e9), times("N/mm²", 1e6)];
/// Times, in seconds unless they say otherwise.
pub const SECONDS: &[Unit] = &[si("s"), MILLISECOND, MICROSECOND];
/// Times, in milliseconds unless they say otherwise.
pub const MILLISECONDS: &[Unit] = &[MILLISECOND, si("s"), MICROSECOND];
/// Times, in microseconds unless they say otherwise.
pub const MICROSECONDS: &[Unit] = &[MICROSECOND, MILLISECOND, si("s")];
/// Speeds.
pub const SPEED: &[Unit] = &[per("mm/s", 1e3), si("m/s")];
/// Accelerations.
pub const ACCELERATION: &[Unit] = &[si("m/s²"), per("mm/s²", 1e3)];
/// Angular accelerations.
pub const ANGULAR_ACCELERATION: &[Unit] = &[si("rad/s²"), times("°/s²", std::f64::consts::PI / 180.0)];
/// Jerks.
pub const JERK: &[Unit] = &[si("m/s³"), per("mm/s³", 1e3)];
/// Angular jerks.
pub const ANGULAR_JERK: &[Unit] = &[si("rad/s³"), times("°/s³", std::f64::consts::PI / 180.0)];
/// Torques of drives.
pub const TORQUE: &[Unit] = &[si("N·m"), per("N·mm", 1e3)];
/// Slopes.
pub const SLOPE: &[Unit] = &[si(""), per("mm/m", 1e3)];
/// What grows with a speed.
pub const PER_SPEED: &[Unit] = &[si("s/m"), times("s/mm", 1e3)];
/// Moments of inertia.
pub const INERTIA: &[Unit] = &[per("g·mm²", 1e9), si("kg·m²"), per("kg·mm²", 1e6)];
/// Angular velocities.
pub const ROTATION: &[Unit] =
    &[si("rad/s"), times("°/s", std::f64::consts::PI / 180.0), times("1/min", std::f64::consts::PI / 30.0)];
/// Gains and dampings about an axis: torques for an angular velocity.
pub const TORQUE_GAIN: &[Unit] = &[si("N·m·s/rad"), per("N·mm·s/rad", 1e3)];
/// Stiffnesses about an axis.
pub const TORSION: &[Unit] = &[si("N·m/rad"), per("N·mm/rad", 1e3)];
/// Dampings and gains: forces for a speed.
pub const DAMPING: &[Unit] = &[times("N·s/mm", 1e3), si("N·s/m")];

/// What a number may be: its units, the first of which is meant where none is given, and its range in that one.
pub struct Quantity {
    /// Units.
    pub units: &'static [Unit],
    /// The least and the greatest value, in the first unit.
    pub range: [f64; 2],
}

impl Unit {
    /// `value` in this unit as SI.
    pub fn to_si(self, value: f64) -> f64 {
        value * self.times / self.per
    }

    /// Whether `text` means this unit, in its common spellings: um, N*s/mm, Ns/mm, m/s^2.
    pub fn is(self, text: &str) -> bool {
        // A point stands for a product; left out or a star instead it may be, but not put in.
        const POINTS: [char; 3] = ['·', '⋅', '*'];
        plain(self.symbol) == plain(text) && (self.symbol.contains(POINTS) || !text.contains(POINTS))
    }
}

/// A unit's symbol in ASCII.
pub fn plain(text: &str) -> String {
    text.chars().fold(String::new(), |mut ascii, character| {
        match character {
            // Micro sign and Greek letter.
            'µ' | 'μ' => ascii.push('u'),
            '²' => ascii.push_str("^2"),
            '°' => ascii.push_str("deg"),
            '·' | '⋅' | '*' => {}
            other => ascii.push(other),
        }
        ascii
    })
}

impl Quantity {
    /// Its units, for a message.
    pub fn units(&self) -> String {
        match self.units {
            [only] if only.symbol.is_empty() => "a number without a unit".into(),
            [first, ..] => {
                let symbols: Vec<_> = self.units.iter().map(|unit| unit.symbol).collect();
                format!("a number in {}, or a text with its unit: {}", first.symbol, symbols.join(", "))
            }
            [] => String::new(),
        }
    }

    /// Its range, for a message.
    pub fn limits(&self) -> String {
        let [least, greatest] = self.range;
        format!("{least} to {greatest} {}", self.units[0].symbol).trim_end().into()
    }

    /// Some value (SI) in range, to stand for one that is wrong.
    pub fn some(&self) -> f64 {
        let [least, greatest] = self.range;
        self.units[0].to_si(1.0f64.clamp(least, greatest))
    }

    /// Whether `value` (SI) is in range.
    pub fn covers(&self, value: f64) -> bool {
        let [least, greatest] = self.range.map(|bound| self.units[0].to_si(bound));
        least <= value && value <= greatest
    }
}

#[cfg(test)]
mod tests {
    use super::{ACCELERATION, DAMPING, LENGTH, MASS, MICROSECONDS, Quantity};

    #[test]
    fn decimals_are_rounded_once() {
        assert_eq!(MASS[0].to_si(81.8), 81.8 / 1000.0);
        assert_eq!(LENGTH[0].to_si(0.0404), 0.0404 / 1000.0);
        assert_eq!(LENGTH[5].to_si(0.5), 0.0127);
        assert_eq!(MICROSECONDS[0].to_si(50.0), 50e-6);
        assert_eq!(DAMPING[0].to_si(0.04), 40.0);
    }

    #[test]
    fn common_spellings_mean_the_same() {
        for text in ["N·s/mm", "N*s/mm", "Ns/mm", "N⋅s/mm"] {
            assert!(DAMPING[0].is(text), "{text}");
        }
        for text in ["µs", "μs", "us"] {
            assert!(MICROSECONDS[0].is(text), "{text}");
        }
        assert!(!LENGTH[0].is("m*m") && !LENGTH[0].is("m·m"));
        assert!(ACCELERATION[0].is("m/s^2") && !ACCELERATION[0].is("m/s") && !LENGTH[0].is("MM"));
    }

    #[test]
    fn ranges_hold_their_ends() {
        let quantity = Quantity { units: LENGTH, range: [-0.1, 100.0] };
        assert!(quantity.covers(-0.1 / 1000.0) && quantity.covers(0.1) && !quantity.covers(0.1001));
        assert!(!quantity.covers(f64::NAN));
    }
}
