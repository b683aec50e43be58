//! The targets of compilation.

/// The target of a compilation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// The simulated board's engines: bytecode.
    #[default]
    Sim,
    /// The controller's processor, a TMS320C67x+.
    C67x,
}
