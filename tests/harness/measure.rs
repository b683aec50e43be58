//! The cycles that a program spends, as counted by the profiling engine; the other engines must agree.

use std::path::Path;

use compiler::{Options, image, pp};
use kmotiondef::timing::Timing;
use kmotiondef::{Cycles, ThreadId, Ticks};
use vm::profile::ProfilingEngine;

use crate::oracles::{counting, execute, execute_everywhere};

/// The board time for a program: a minute.
const LIMIT: Ticks = Ticks::new(666_667);

/// The cycles for which the program computes in thread 1, including firmware functions; `None` if it does not compile.
pub(crate) fn cycles(path: &Path, source: Vec<u8>) -> Option<i64> {
    let options = Options { timing: Timing::Fast, ..Options::default() };
    let mut compilation = compiler::compile(path, source, &options, &pp::Disk);
    let linked = compilation.link(ThreadId::new(1)?, &options)?;
    let image = image::write(&linked).expect("what is linked can be written");
    let (profiled, board) =
        execute::<ProfilingEngine>(&image, LIMIT, counting()).expect("what the compiler makes can be loaded");
    let seen = execute_everywhere(&image, LIMIT).expect("what one engine takes, all take");
    assert_eq!(seen, profiled, "{}: the profiling engine differs", path.display());
    let sites = board.machine().engine().profile().sites();
    Some(sites.map(|(_, spent)| spent.computing).fold(Cycles::new(0), |sum, spent| sum + spent).get())
}
