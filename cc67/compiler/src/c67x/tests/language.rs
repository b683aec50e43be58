//! What the processor has no instruction for, and what the vendor's compiler gets wrong.
//!
//! The program divides doubles and singles at random, with estimates of the firmware that are off by up to three
//! units of the last place; what it prints was computed by another compiler.

use super::{build, machine};
use crate::passes::Level;

const SOURCE: &str = include_str!("language.c");

const PRINTED: &str = "\
072dbb8f
4 3 -2.500000
382
1 2 0 0
-1 5 7 11 13 17 19 -1 24
57d282b8
0 1
1 -3
3000000000 3000000000.000000
";

#[test]
fn quotients_wide_integers_structures_and_many_arguments_are_right() {
    for level in [Level::None, Level::Full] {
        assert_eq!(machine::run(&build(SOURCE, level)).console, PRINTED, "{level:?}");
    }
}
