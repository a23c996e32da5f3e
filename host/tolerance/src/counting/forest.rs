//! Sums of blocks joined in the shape of one fixed binary tree, in whatever order the blocks come.
//!
//! Floating-point addition is not associative: only a shape that depends on nothing but the blocks' numbers gives the
//! same bytes for any number of threads and any split over machines. Node (h, k) holds blocks k·2ʰ to (k + 1)·2ʰ − 1.

use std::collections::BTreeMap;

use super::tally::Sums;

/// Joined as far as neighbours are there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forest {
    /// By the number of the first block, so that whole trees lie from left to right.
    nodes: BTreeMap<u64, (u32, Sums)>,
}

impl Forest {
    /// Adds the node of height `height` that starts at block `first`, a multiple of 2^`height`.
    pub fn insert(&mut self, mut first: u64, mut height: u32, mut sums: Sums) {
        loop {
            let size = 1 << height;
            let sibling = first ^ size;
            match self.nodes.get(&sibling) {
                Some((other, _)) if *other == height => {}
                _ => break,
            }
            let Some((_, other)) = self.nodes.remove(&sibling) else { break };
            sums = if sibling < first { other.joined(&sums) } else { sums.joined(&other) };
            first &= !size;
            height += 1;
        }
        self.nodes.insert(first, (height, sums));
    }

    /// Its trees: first block, height, sums.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = (u64, u32, &Sums)> {
        self.nodes.iter().map(|(first, (height, sums))| (*first, *height, sums))
    }

    /// Everything together; `None` if empty.
    pub fn total(&self) -> Option<Sums> {
        self.nodes.values().rev().map(|(_, sums)| sums.clone()).reduce(|right, left| left.joined(&right))
    }
}

#[cfg(test)]
mod tests {
    use super::{Forest, Sums};

    fn block(k: u64) -> Sums {
        Sums { powers: vec![[libm::sin(k as f64), 0.1, 1e16 / (k + 1) as f64, 1.0]], products: vec![] }
    }

    #[test]
    fn any_order_gives_the_same_bits() {
        for blocks in [1u64, 2, 7, 64, 77] {
            let mut forward = Forest::default();
            (0..blocks).for_each(|k| forward.insert(k, 0, block(k)));
            let mut order: Vec<u64> = (0..blocks).collect();
            order.sort_by_key(|k| k * 31 % 77);
            let mut scattered = Forest::default();
            order.into_iter().for_each(|k| scattered.insert(k, 0, block(k)));
            assert_eq!(forward, scattered);
            // In parts, each joined on its own before.
            let mut joined = Forest::default();
            for part in [blocks / 3..blocks, 0..blocks / 3] {
                let mut forest = Forest::default();
                part.for_each(|k| forest.insert(k, 0, block(k)));
                forest.nodes().for_each(|(first, height, sums)| joined.insert(first, height, sums.clone()));
            }
            assert_eq!(forward, joined);
            assert_eq!(forward.total(), joined.total());
        }
    }
}
