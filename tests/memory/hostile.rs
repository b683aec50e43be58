//! Mutated and random bytes through all readers: no panic, little memory, and a reason for every rejection.
//!
//! `cargo test` tries 50,000 of each kind; with `CC67_LONG=1` in the environment a million, for which a release build
//! is advisable.

use harness::is_long;
use harness::oracles::{read_file, valid_files};
use harness::random::Random;

use crate::{MEMORY, alone};

/// The maximum number of bytes that reading one file may take.
const LIMIT: usize = 64 << 20;

/// Changes a few bytes, most of them in the headers, to values that often cause errors; may truncate the end.
fn mutate(bytes: &mut Vec<u8>, numbers: &mut Random) {
    const AWKWARD: [u8; 8] = [0, 1, 2, 0x7f, 0x80, 0xfe, 0xff, 0x10];
    for _ in 0..=numbers.below(6) {
        let range = if numbers.below(3) == 0 { bytes.len() } else { bytes.len().min(200) };
        let at = numbers.below(range.max(1));
        let value = if numbers.below(2) == 0 { AWKWARD[numbers.below(8)] } else { numbers.draw() as u8 };
        if let Some(byte) = bytes.get_mut(at) {
            *byte = value;
        }
    }
    if numbers.below(4) == 0 {
        bytes.truncate(numbers.below(bytes.len() + 1));
    }
}

fn random(numbers: &mut Random) -> Vec<u8> {
    let mut bytes: Vec<u8> = (0..numbers.below(400)).map(|_| numbers.draw() as u8).collect();
    // Most data that do not begin like an image are rejected at once.
    if numbers.below(2) == 0 {
        bytes.splice(..bytes.len().min(2), [0xC2, 0]);
    }
    if numbers.below(4) == 0 && bytes.len() > 22 {
        bytes[2..4].copy_from_slice(&[2, 0]);
        bytes[16..22].copy_from_slice(&[28, 0, 0x43, 0x11, 1, 0x67]);
    }
    bytes
}

#[test]
fn hostile_files_do_no_harm() {
    let _alone = alone();
    let rounds = if is_long() { 1_000_000 } else { 50_000 };
    let seeds = valid_files();
    let mut numbers = Random::new(0x6701_C0FF);
    let (mut accepted, mut most) = (0, 0);
    for round in 0..rounds {
        let bytes = if round % 4 == 3 {
            random(&mut numbers)
        } else {
            let mut bytes = seeds[numbers.below(seeds.len())].clone();
            mutate(&mut bytes, &mut numbers);
            bytes
        };
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        accepted += usize::from(read_file(&bytes));
        most = most.max(MEMORY.peak_usage().saturating_sub(before));
        assert!(most <= LIMIT, "round {round} takes {most} bytes");
    }
    println!("{rounds} files, {accepted} of them loadable, at most {most} bytes for one");
    assert!(accepted > 0, "the mutations spare some images");
}
