#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| shapespline_tests::fuzz::run("regular", data));
