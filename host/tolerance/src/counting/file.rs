//! A part of a study on disk: what a shard found, or how far a run has come.
//!
//! Little-endian: 8 bytes `SLIPSTDY`, version (u32), length of the header (u32), header (JSON: scene, settings, which
//! blocks), tallies, CRC-32/ISO-HDLC of all before. Of each tally: units, rejected, measures, sums, then of each measure
//! undefined, outside, extremes (f64), units at the extremes, bins, bins beyond (how many, and of each its number, zigzag, and units); closings; trees, and of each first block, height, sums (f64). Integers are
//! LEB128. Everything that a reader allocates it has seen the bytes of.

use std::collections::BTreeMap;

use crc::{CRC_32_ISO_HDLC, Crc};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::{
    forest::Forest,
    study::{Settings, Tally, join},
    tally::{BINS, Counts, MeasureCounts, Sums},
};
use crate::{model::Model, sampling::sampler};

const VERSION: u32 = 5;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The scene a study belongs to, as it was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Name of the file, for messages.
    pub name: String,
    /// Its text.
    pub text: String,
    /// What `--set` changed.
    pub set: Vec<String>,
    /// Hash of the measured parts that it refers to, if it does.
    pub measured: Option<u64>,
}

impl Source {
    /// Whether it describes the same scene: the name may differ.
    pub fn is_same(&self, other: &Self) -> bool {
        self.text == other.text && self.set == other.set && self.measured == other.measured
    }
}

/// What parts of a study find, and how it is written.
pub trait Found: Sized {
    /// What the study is made with.
    type Settings: Copy + PartialEq + Serialize + DeserializeOwned;
    /// The first bytes of its files.
    const MAGIC: &'static [u8; 8];

    /// Blocks of the whole study.
    fn blocks(settings: &Self::Settings) -> u64;
    /// What differs between two studies of the same scene, if anything does.
    fn difference(one: &Self::Settings, other: &Self::Settings) -> Option<&'static str>;
    /// Units that were worked on.
    fn units(&self) -> u64;
    /// Whether another part can be joined.
    fn fits(&self, other: &Self) -> bool;
    /// Adds another part.
    fn join(&mut self, other: Self);
    /// Adds its bytes.
    fn encode(&self, out: &mut Vec<u8>);
    /// Reads them.
    ///
    /// # Errors
    /// [`FormatError::Damaged`].
    fn decode(reader: &mut Reader) -> Result<Self, FormatError>;
}

/// Which part of a study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header<S = Settings> {
    /// Version of the sampler.
    pub sampler: u32,
    /// The scene.
    pub source: Source,
    /// What is drawn.
    pub settings: S,
    /// Which shard, from 1 on, of how many.
    pub shard: [u64; 2],
    /// Blocks of the shard that are done.
    pub done: u64,
}

/// A header with what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Part<F: Found = Vec<Tally>> {
    /// Which part.
    pub header: Header<F::Settings>,
    /// What was found: of a tolerance analysis one tally a replicate.
    pub tallies: F,
}

/// Why bytes are no part of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    /// Something else, such as a shard of another command.
    #[error("it is not a study file of the same command and kind of scene")]
    Foreign,
    /// Made by another version.
    #[error("its format is version {0}, allowed is {VERSION}")]
    Version(u32),
    /// Drawn by another version.
    #[error("its units are of version {0} of the sampler, allowed is {allowed}", allowed = sampler::VERSION)]
    Sampler(u32),
    /// Cut off or changed.
    #[error("it is truncated or corrupted")]
    Damaged,
}

impl<F: Found> Part<F> {
    /// The bytes of the file.
    ///
    /// # Errors
    /// If the header cannot be written as JSON, which never happens.
    pub fn encode(&self) -> Result<Vec<u8>, serde_json::Error> {
        let header = serde_json::to_vec(&self.header)?;
        let mut out = F::MAGIC.to_vec();
        out.extend(VERSION.to_le_bytes());
        out.extend((header.len() as u32).to_le_bytes());
        out.extend(header);
        self.tallies.encode(&mut out);
        out.extend(CRC.checksum(&out).to_le_bytes());
        Ok(out)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`FormatError`], if it is not whole.
    pub fn decode(bytes: &[u8]) -> Result<Self, FormatError> {
        if !bytes.starts_with(F::MAGIC) {
            return Err(if F::MAGIC.starts_with(bytes) { FormatError::Damaged } else { FormatError::Foreign });
        }
        let (body, checksum) = bytes.split_last_chunk::<4>().ok_or(FormatError::Damaged)?;
        if CRC.checksum(body) != u32::from_le_bytes(*checksum) {
            return Err(FormatError::Damaged);
        }
        let mut reader = Reader(body.get(F::MAGIC.len()..).ok_or(FormatError::Damaged)?);
        let version = u32::from_le_bytes(reader.array()?);
        if version != VERSION {
            return Err(FormatError::Version(version));
        }
        let length = u32::from_le_bytes(reader.array()?) as usize;
        let header: Header<F::Settings> =
            serde_json::from_slice(reader.bytes(length)?).map_err(|_| FormatError::Damaged)?;
        if header.sampler != sampler::VERSION {
            return Err(FormatError::Sampler(header.sampler));
        }
        let tallies = F::decode(&mut reader)?;
        if reader.0.is_empty() { Ok(Self { header, tallies }) } else { Err(FormatError::Damaged) }
    }
}

impl Part {
    /// Whether its tallies have the shape that `model` and its settings give them.
    pub fn fits(&self, model: &Model) -> bool {
        let shape = |counts: &Counts| [counts.measures.len(), counts.closed.len()];
        self.tallies.len() as u64 == self.header.settings.replicates
            && self.tallies.iter().all(|tally| shape(&tally.counts) == [model.measures.len(), model.sums.len()])
    }
}

impl Found for Vec<Tally> {
    type Settings = Settings;
    const MAGIC: &'static [u8; 8] = b"SLIPSTDY";

    fn blocks(settings: &Settings) -> u64 {
        settings.blocks()
    }

    fn difference(one: &Settings, other: &Settings) -> Option<&'static str> {
        if one.seed != other.seed {
            Some("seed")
        } else if one.method != other.method {
            Some("method")
        } else {
            (one != other).then_some("number of samples")
        }
    }

    fn units(&self) -> u64 {
        self.iter().map(|tally| tally.counts.units).sum()
    }

    fn fits(&self, other: &Self) -> bool {
        self.len() == other.len()
    }

    fn join(&mut self, other: Self) {
        join(self, &other);
    }

    fn encode(&self, out: &mut Vec<u8>) {
        integer(out, self.len() as u64);
        for Tally { counts, sums } in self {
            for count in [counts.units, counts.rejected, counts.measures.len() as u64, counts.closed.len() as u64] {
                integer(out, count);
            }
            for measure in &counts.measures {
                [measure.undefined].iter().chain(&measure.outside).for_each(|count| integer(out, *count));
                measure.extremes.iter().for_each(|extreme| out.extend(extreme.to_le_bytes()));
                measure.at_extremes.iter().for_each(|count| integer(out, *count));
                measure.bins.iter().for_each(|count| integer(out, *count));
                integer(out, measure.far.len() as u64);
                for (bin, count) in &measure.far {
                    integer(out, u64::from(((bin << 1) ^ (bin >> 31)) as u32));
                    integer(out, *count);
                }
            }
            counts.closed.iter().for_each(|count| integer(out, *count));
            integer(out, sums.nodes().len() as u64);
            for (first, height, sums) in sums.nodes() {
                integer(out, first);
                integer(out, height.into());
                sums.powers.iter().flatten().chain(&sums.products).for_each(|sum| out.extend(sum.to_le_bytes()));
            }
        }
    }

    fn decode(reader: &mut Reader) -> Result<Self, FormatError> {
        let count = reader.count()?;
        (0..count).map(|_| reader.tally()).collect()
    }
}

/// Adds an integer.
pub fn integer(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// What is left of a file.
pub struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn bytes(&mut self, count: usize) -> Result<&'a [u8], FormatError> {
        let (bytes, rest) = self.0.split_at_checked(count).ok_or(FormatError::Damaged)?;
        self.0 = rest;
        Ok(bytes)
    }

    /// So many bytes.
    ///
    /// # Errors
    /// [`FormatError::Damaged`], if there are fewer.
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], FormatError> {
        let (array, rest) = self.0.split_first_chunk::<N>().ok_or(FormatError::Damaged)?;
        self.0 = rest;
        Ok(*array)
    }

    /// A number.
    ///
    /// # Errors
    /// [`FormatError::Damaged`], if there is none.
    pub fn number(&mut self) -> Result<f64, FormatError> {
        self.array().map(f64::from_le_bytes)
    }

    /// An integer.
    ///
    /// # Errors
    /// [`FormatError::Damaged`], if there is none.
    pub fn integer(&mut self) -> Result<u64, FormatError> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let [byte] = self.array()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(FormatError::Damaged)
    }

    /// A number of things that take a byte each at least.
    ///
    /// # Errors
    /// [`FormatError::Damaged`], if there is none, or fewer bytes.
    pub fn count(&mut self) -> Result<usize, FormatError> {
        let count = self.integer()? as usize;
        if count <= self.0.len() { Ok(count) } else { Err(FormatError::Damaged) }
    }

    fn tally(&mut self) -> Result<Tally, FormatError> {
        let (units, rejected) = (self.integer()?, self.integer()?);
        let (measures, closed) = (self.count()?, self.count()?);
        let mut counts = Counts { units, rejected, measures: Vec::new(), closed: Vec::new() };
        for _ in 0..measures {
            let undefined = self.integer()?;
            let outside = [self.integer()?, self.integer()?];
            let extremes = [self.number()?, self.number()?];
            let at_extremes = [self.integer()?, self.integer()?];
            let bins = (0..BINS).map(|_| self.integer()).collect::<Result<_, _>>()?;
            let mut far = BTreeMap::new();
            for _ in 0..self.count()? {
                let zigzag = u32::try_from(self.integer()?).map_err(|_| FormatError::Damaged)?;
                far.insert((zigzag >> 1) as i32 ^ -((zigzag & 1) as i32), self.integer()?);
            }
            counts.measures.push(MeasureCounts { undefined, outside, extremes, at_extremes, bins, far });
        }
        counts.closed = (0..closed).map(|_| self.integer()).collect::<Result<_, _>>()?;
        let mut sums = Forest::default();
        for _ in 0..self.count()? {
            let (first, height) = (self.integer()?, self.integer()?);
            let height = u32::try_from(height).ok().filter(|height| *height < 64).ok_or(FormatError::Damaged)?;
            let mut node = Sums::new(measures);
            for sum in node.powers.iter_mut().flatten().chain(&mut node.products) {
                *sum = self.number()?;
            }
            sums.insert(first, height, node);
        }
        Ok(Tally { counts, sums })
    }
}
