//! See the oracle of this name.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| harness::views::page(bytes));
