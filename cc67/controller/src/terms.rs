//! The terms on which programs are loaded.

/// The time at which programs start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgramStart {
    /// When all of them are loaded.
    #[default]
    AtOnce,
    /// With the first call that lets time pass: a recording can begin before.
    WithTime,
    /// With a later [`Session::start`](cc67_host::Session::start).
    ByCall,
}

/// The terms on which programs are loaded into a controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadTerms {
    /// Loads programs even if they were linked for another firmware.
    pub is_forced: bool,
    /// The time at which the programs marked as started begin.
    pub start: ProgramStart,
    /// Compares the memory of the controller with the program after each load, with a program in a free thread.
    pub verifies: bool,
    /// Allows [cc67's monitor](crate#the-monitor), which reads memory, in a free thread.
    pub has_monitor: bool,
}
