//! Tables for tests.

use std::vec::Vec;

use super::{AxisKind, Encoding, layout, motions};

/// The scene that they are made for.
pub(crate) const SCENE: u64 = 7;

/// A table in f32 over axes given as their nodes and their distance, from 0 on; `force` (N) says the force at a node, which
/// counts up, the last axis fastest. The velocity (m/s) is a tenth of it.
pub(crate) fn table(axes: &[(AxisKind, u32, f32)], force: impl Fn(u32) -> f32) -> Vec<u8> {
    let nodes = axes.iter().map(|(_, count, _)| count).product();
    let values = (0..nodes).map(force).flat_map(|force| [force, 0.1 * force]).flat_map(f32::to_le_bytes);
    sealed(axes, Encoding::F32, 1.0, values)
}

/// The same in i16; forces and velocities count in thousandths.
pub(crate) fn table_of_integers(axes: &[(AxisKind, u32, f32)], force: impl Fn(u32) -> i16) -> Vec<u8> {
    let nodes = axes.iter().map(|(_, count, _)| count).product();
    let values = (0..nodes).map(force).flat_map(|force| [force, force / 10]).flat_map(i16::to_le_bytes);
    sealed(axes, Encoding::I16, 1e-3, values)
}

fn sealed(axes: &[(AxisKind, u32, f32)], encoding: Encoding, scale: f32, values: impl Iterator<Item = u8>) -> Vec<u8> {
    let values: Vec<u8> = values.collect();
    let verdicts = motions(axes.iter().map(|(_, count, _)| *count as usize)).unwrap().next_multiple_of(4);
    let padding = layout::CHANNELS * encoding.size() + verdicts;
    let length = layout::HEADER_SIZE + values.len() + padding + layout::CHECKSUM_SIZE;
    let mut bytes = Vec::from(layout::MAGIC);
    bytes.extend(layout::VERSION.to_le_bytes());
    bytes.extend([axes.len() as u8, encoding as u8]);
    bytes.extend(SCENE.to_le_bytes());
    bytes.extend((length as u32).to_le_bytes());
    for (kind, count, step) in axes {
        bytes.extend([*kind as u8, 0, 0, 0]);
        bytes.extend(count.to_le_bytes());
        bytes.extend([0.0, *step].map(f32::to_le_bytes).concat());
    }
    bytes.resize(layout::CHANNELS_AT, 0);
    bytes.extend([scale, 0.0, 0.0, scale, 0.0, 0.0].map(f32::to_le_bytes).concat());
    bytes.extend(values);
    bytes.resize(bytes.len() + padding, 0);
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

/// Adds the record of a production to a table of rows.
pub(crate) fn insert_record(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = f32>) {
    bytes.truncate(bytes.len() - layout::CHECKSUM_SIZE);
    bytes.extend(numbers.flat_map(f32::to_le_bytes));
    let length = (bytes.len() + layout::CHECKSUM_SIZE) as u32;
    bytes[layout::LENGTH_AT..][..4].copy_from_slice(&length.to_le_bytes());
    bytes.extend(layout::checksum(bytes).to_le_bytes());
}

/// Replaces it.
pub(crate) fn replace_record(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = f32>) {
    bytes.truncate(bytes.len() - layout::PRODUCTION_SIZE);
    insert_record(bytes, numbers);
}
