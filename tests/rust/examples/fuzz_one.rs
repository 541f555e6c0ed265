// SPDX-License-Identifier: MIT OR Apache-2.0

//! Runs one input of a fuzz target: `cargo run -p shapespline-tests --example fuzz_one -- TARGET FILE`.
#![allow(clippy::unwrap_used, reason = "a tool for developers")]

fn main() {
    let [target, file]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().unwrap();
    shapespline_tests::fuzz::run(&target, &std::fs::read(file).unwrap());
}
