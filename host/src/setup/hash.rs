//! The hash that ties a table to the scene and the laws it was made from.

use crc::{CRC_64_XZ, Crc};
use slipfit_core::{
    menu::{FrictionData, FrictionType, NormalType, SlideData},
    slide::CONTACTS,
};

/// To be raised when a law changes its results: tables made before are refused then.
const LAWS: u8 = 3;

/// CRC-64/XZ of the physics of every unit: what the entries of a table depend on, apart from its grid.
///
/// `data` has the gaps at tolerance level 0, `deviations` (m) say how they vary with n. All numbers have to be finite; −0 counts as 0. Hashed are, in this order: a version of the laws
/// (u8), the type of the normal law (u8: 1 linear, 2 exponent 3/2, 3 any other), that of the friction law (u8: 0 none,
/// 1 regularised, 2 exact), and as little-endian f64 mass, inertia, gravity, pins, gaps, deviations, stiffness, exponent,
/// damping, depth, friction coefficient and stick band (0 where there is none), gain, start, end and speed of the
/// drive, its point.
pub fn scene_hash(data: &SlideData<f64>, deviations: &[f64; CONTACTS]) -> u64 {
    let SlideData { body, contact, friction, drive } = data;
    let normal_type = match contact.normal_type() {
        NormalType::Linear => 1,
        NormalType::ThreeHalves => 2,
        NormalType::Power => 3,
    };
    let (friction_type, coefficient, stick_band) = match (friction.friction_type(), friction) {
        (FrictionType::Frictionless, _) | (_, FrictionData::None) => (0, 0.0, 0.0),
        (_, FrictionData::Regularised { coefficient, stick_band }) => (1, *coefficient, *stick_band),
        (_, FrictionData::Exact { coefficient }) => (2, *coefficient, 0.0),
    };

    let mut numbers = vec![body.mass];
    numbers.extend(&body.inertia_b);
    numbers.extend(&body.gravity_w);
    numbers.extend(body.pins_w.iter().flatten());
    numbers.extend(body.gaps);
    numbers.extend(deviations);
    numbers.extend([contact.stiffness, contact.exponent, contact.damping, contact.depth, coefficient, stick_band]);
    numbers.extend([drive.gain, drive.ramp_start, drive.ramp_end, drive.speed]);
    numbers.extend(&drive.point_b);

    let mut digest = Digest::new();
    digest.bytes(&[normal_type, friction_type]);
    digest.numbers(numbers);
    digest.finish()
}

static CRC: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);

/// A hash of physics, fed part by part.
pub struct Digest(crc::Digest<'static, u64>);

impl Digest {
    /// Of the laws alone.
    pub fn new() -> Self {
        let mut digest = Self(CRC.digest());
        digest.bytes(&[LAWS]);
        digest
    }

    /// Takes in bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Takes in counts and choices, as little-endian u32.
    pub fn counts(&mut self, counts: impl IntoIterator<Item = usize>) {
        counts.into_iter().for_each(|count| self.bytes(&(count as u32).to_le_bytes()));
    }

    /// Takes in numbers, as little-endian f64; −0 counts as 0.
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        numbers.into_iter().for_each(|number| self.bytes(&(number + 0.0).to_le_bytes()));
    }

    /// The hash.
    pub fn finish(self) -> u64 {
        self.0.finalize()
    }
}

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{CONTACTS, FrictionData, SlideData, scene_hash};
    use slipfit_problems::cd_rom;

    fn hash(change: impl Fn(&mut SlideData<f64>)) -> u64 {
        let mut data = cd_rom::data(0.0);
        change(&mut data);
        scene_hash(&data, &cd_rom::TABLE_2.map(|[_, deviation]| deviation / 1000.0))
    }

    #[test]
    fn is_what_it_was() {
        // Another value here refuses every table in the field: raise `LAWS` only on purpose.
        assert_eq!(format!("{:016x}", hash(|_| ())), "83f741c20cd1f0bd");
    }

    #[test]
    fn sees_every_field() {
        let up = |x: &mut f64| *x += 1e-9;
        let mut hashes = vec![
            hash(|_| ()),
            hash(|data| up(&mut data.body.mass)),
            hash(|data| up(&mut data.contact.stiffness)),
            hash(|data| up(&mut data.contact.exponent)),
            hash(|data| up(&mut data.contact.damping)),
            hash(|data| up(&mut data.contact.depth)),
            hash(|data| data.friction = FrictionData::None),
            hash(|data| data.friction = FrictionData::Regularised { coefficient: 0.2, stick_band: 1e-4 }),
            hash(|data| data.friction = FrictionData::Regularised { coefficient: 0.3, stick_band: 2e-4 }),
            hash(|data| up(&mut data.drive.gain)),
            hash(|data| up(&mut data.drive.ramp_start)),
            hash(|data| up(&mut data.drive.ramp_end)),
            hash(|data| up(&mut data.drive.speed)),
        ];
        for i in 0..3 {
            hashes.push(hash(|data| up(&mut data.body.inertia_b[i])));
            hashes.push(hash(|data| up(&mut data.body.gravity_w[i])));
            hashes.push(hash(|data| up(&mut data.drive.point_b[i])));
            hashes.extend([0, 1, 2, 3].map(|pin| hash(|data| up(&mut data.body.pins_w[pin][i]))));
        }
        hashes.extend((0..CONTACTS).map(|i| hash(|data| up(&mut data.body.gaps[i]))));

        let data = cd_rom::data(0.0);
        let deviations = cd_rom::TABLE_2.map(|[_, deviation]| deviation / 1000.0);
        for i in 0..CONTACTS {
            let mut deviations = deviations;
            up(&mut deviations[i]);
            hashes.push(scene_hash(&data, &deviations));
        }

        let count = hashes.len();
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), count);
    }

    #[test]
    fn does_not_see_how_the_same_thing_is_written() {
        assert_eq!(hash(|_| ()), hash(|data| data.body.gravity_w.x = -0.0));
        let without = |coefficient, stick_band| FrictionData::Regularised { coefficient, stick_band };
        assert_eq!(hash(|data| data.friction = FrictionData::None), hash(|data| data.friction = without(0.0, 1e-3)));
    }
}
