// SPDX-License-Identifier: MIT OR Apache-2.0

//! The fuzz targets as an ordinary test: every input that was ever a finding, and thousands of generated ones.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use std::{panic::catch_unwind, path::Path, time::Duration};

use shapespline_tests::{
    fuzz::{TARGETS, run},
    generate::Random,
};

/// What takes longer than this hangs, on the slowest and busiest machine.
const LIMIT: Duration = Duration::from_secs(120);

/// How many inputs are generated for a target: `FUZZ_INPUTS` for a longer run by hand.
fn inputs() -> usize {
    std::env::var("FUZZ_INPUTS").ok().and_then(|n| n.parse().ok()).unwrap_or(3000)
}

/// Runs an input; what panics is said with the bytes that did it.
fn survive(target: &str, data: &[u8], origin: &str) {
    let (tell, hear) = std::sync::mpsc::channel();
    let input = data.to_vec();
    let name = target.to_owned();
    // In a thread of its own: what hangs is told as well.
    std::thread::spawn(move || {
        let outcome = catch_unwind(|| run(&name, &input));
        let _ = tell.send(outcome.is_ok());
    });
    match hear.recv_timeout(LIMIT) {
        Ok(held) => assert!(held, "{target} fails on {origin}: {data:?}"),
        Err(_) => panic!("{target} takes more than {LIMIT:?} on {origin}: {data:?}"),
    }
}

/// Bytes of which many are small or the same again, as in what a fuzzer finds.
fn generated(random: &mut Random) -> Vec<u8> {
    let n = 1 + random.below(300);
    let coarse = random.below(3) == 0;
    let most = if coarse { 12 } else { 256 };
    (0..n).map(|_| random.below(most) as u8).collect()
}

/// The targets side by side: there is no need to wait for one with the others.
#[test]
fn every_kept_input_and_thousands_of_generated_ones() {
    let only = std::env::var("FUZZ_TARGET").ok();
    std::thread::scope(|scope| {
        for (k, (target, _)) in TARGETS.iter().enumerate() {
            if only.as_ref().is_none_or(|only| only == target) {
                scope.spawn(move || survive_all(target, Random::new(k as u64)));
            }
        }
    });
}

fn survive_all(target: &str, mut random: Random) {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let mut files: Vec<_> =
        std::fs::read_dir(kept).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "no input is kept for {target}");
    for file in &files {
        survive(target, &std::fs::read(file).unwrap(), &file.display().to_string());
    }
    for i in 0..inputs() {
        survive(target, &generated(&mut random), &format!("generated input {i}"));
    }
}
