// SPDX-License-Identifier: MIT OR Apache-2.0

//! Isotonic regression: the monotone values nearest to the data, what smoothing tends to as its penalty falls to 0.

/// A run of data with one value.
struct Block {
    value: f64,
    weight: f64,
    count: usize,
}

/// The non-decreasing values between the bounds that minimise `Σ w(y − f)²`, by pooling adjacent violators. O(N).
pub(super) fn isotonic(y: &[f64], w: &[f64], [low, high]: [f64; 2]) -> Vec<f64> {
    let mut blocks: Vec<Block> = Vec::new();
    for (y, w) in y.iter().zip(w) {
        let mut own = Block { value: *y, weight: *w, count: 1 };
        while let Some(before) = blocks.pop_if(|before| before.value >= own.value) {
            let weight = before.weight + own.weight;
            let share = own.weight / weight;
            own.value = before.value + (own.value - before.value) * share;
            (own.weight, own.count) = (weight, own.count + before.count);
        }
        blocks.push(own);
    }
    let value = |block: &Block| block.value.max(low).min(high);
    blocks.iter().flat_map(|block| std::iter::repeat_n(value(block), block.count)).collect()
}
