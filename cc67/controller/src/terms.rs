//! The terms on which programs are loaded.

/// The moment at which programs start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgramStart {
    /// When all are loaded.
    #[default]
    AtOnce,
    /// With the first call that lets time pass: a recording begins before.
    WithTime,
    /// With a later [`Session::start`](cc67_host::Session::start).
    ByCall,
}

/// The terms on which programs are loaded into a controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadTerms {
    /// Loads programs also where they were linked for another firmware.
    pub is_forced: bool,
    /// The moment at which the programs that should start do so.
    pub start: ProgramStart,
    /// Compares the memory of the controller with the program after each load, by a program in a free thread.
    pub verifies: bool,
    /// Allows [cc67's monitor](crate#the-monitor), which reads memory, in a free thread.
    pub has_monitor: bool,
}
