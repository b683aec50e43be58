//! The terms on which programs are loaded.

/// The terms on which programs are loaded into a controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadTerms {
    /// Loads programs also where they were linked for another firmware.
    pub is_forced: bool,
    /// Leaves the programs that should start for a later [`Session::start`](cc67_host::Session::start).
    pub starts_later: bool,
    /// Compares the memory of the controller with the program after each load, by a program in a free thread.
    pub verifies: bool,
    /// Allows [cc67's monitor](crate#the-monitor), which reads memory, in a free thread.
    pub has_monitor: bool,
}
