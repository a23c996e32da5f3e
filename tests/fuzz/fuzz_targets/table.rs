//! The table reader: any bytes are refused or give finite numbers. Tables of a length that fits get the checksum they
//! need, so that more than the header is reached.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipfit_core::table::{AxisKind, Scrubber, Slots, Table, Word, layout};

fuzz_target!(|input: (Vec<u8>, [f32; 3])| {
    let (mut bytes, at) = input;
    opened(&bytes, at);
    let length = bytes.len();
    if length >= layout::HEADER_SIZE + layout::CHECKSUM_SIZE {
        bytes[..4].copy_from_slice(&layout::MAGIC);
        bytes[layout::VERSION_AT..][..2].copy_from_slice(&layout::VERSION.to_le_bytes());
        bytes[layout::LENGTH_AT..][..4].copy_from_slice(&(length as u32).to_le_bytes());
        let body = length - layout::CHECKSUM_SIZE;
        let checksum = layout::checksum(&bytes[..body]);
        bytes[body..].copy_from_slice(&checksum.to_le_bytes());
        opened(&bytes, at);
    }
});

fn opened(bytes: &[u8], [a, b, c]: [f32; 3]) {
    if let Ok(table) = Table::<2>::open(bytes) {
        let found = table.lookup([a, b]);
        assert!(found.force.is_finite() && found.velocity.is_finite());
        let mut scrubber = Scrubber::new(&table);
        while !scrubber.check(bytes, 64).expect("it has just been checked") {}
    }
    if let Ok(table) = Table::<3>::open(bytes) {
        let found = table.lookup([a, b, c]);
        assert!(found.force.is_finite() && found.velocity.is_finite());
    }
    let (first, second) = bytes.split_at(bytes.len() / 2);
    let word = Word::of(1 << (bytes.len() % 6)).expect("a power of two up to 32");
    let (slot, _) = Slots::<2>::open([Some(first), Some(second)], word, [AxisKind::Level, AxisKind::Time], 0).spare();
    assert!(slot < 2);
}
