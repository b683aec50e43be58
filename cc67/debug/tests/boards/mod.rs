//! Busy boards, to measure the cost of a debugger.

use std::path::PathBuf;

use cc67_host::{Session, Setup, UserProgram};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};
use runtime::MachineFile;

/// The tick that ends after a time in seconds.
pub(crate) fn tick(seconds: f64) -> Ticks {
    Ticks::new((seconds / TIMEBASE).round() as u64)
}

/// A board with the programs running in threads 1, 2, …. Their sources are written to `folder`, where a debugger reads
/// them.
pub(crate) fn board(folder: &PathBuf, machine: &str, programs: &[(&str, &str)]) -> Session {
    std::fs::create_dir_all(folder).expect("a folder");
    let mut setup = Setup::default();
    setup.config.machine_file = MachineFile::parse(machine).expect("it is right");
    for ((name, text), thread) in programs.iter().zip(ThreadId::all()) {
        let file = folder.join(name);
        std::fs::write(&file, text).expect("a file");
        let program = UserProgram::compile(&file, thread, &setup.options).expect("it compiles");
        setup.programs.push(program.started());
    }
    setup.session().expect("a board")
}
