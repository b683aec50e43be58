//! The time that programs and the firmware take: the choice that the compiler and the board share.

/// The code whose cycles count as the board's time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// The cycles of the vendor compiler's code for the source, on the board (`spec/costs.md`).
    Vendor(WaitStates),
    /// A cycle or two for each instruction, whatever the board would take.
    Fast,
}

impl Default for Timing {
    fn default() -> Self {
        Self::VENDOR
    }
}

impl Timing {
    /// The board's timing, with the known wait states of its memory.
    pub const VENDOR: Self = Self::Vendor(WaitStates::REGISTERS);

    /// The wait states that are counted; `None` if time is not the board's.
    #[must_use]
    #[inline]
    pub const fn wait_states(self) -> Option<WaitStates> {
        match self {
            Self::Vendor(waits) => Some(waits),
            Self::Fast => None,
        }
    }
}

/// Cycles that the processor waits for memory outside it.
///
/// The firmware programs the bus so that a register of the FPGA takes 44. What SDRAM takes is known from no board; 20
/// is an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitStates {
    /// For an access to a register of the FPGA or to flash.
    pub register: u32,
    /// For each 32 bits of data in SDRAM.
    pub sdram: u32,
}

impl WaitStates {
    /// Memory that never waits.
    pub const NONE: Self = Self { register: 0, sdram: 0 };
    /// The wait states that the firmware programs into the bus.
    pub const REGISTERS: Self = Self { register: 44, sdram: 0 };

    /// The wait states of a name: `none`, `io44`, `io44_sd20` and the like, or the cycles of SDRAM alone.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        if name == "none" {
            return Some(Self::NONE);
        }
        let most = |cycles: &u32| *cycles <= 1000;
        if let Ok(sdram) = name.parse() {
            return Some(Self { sdram, ..Self::REGISTERS }).filter(|waits| most(&waits.sdram));
        }
        let (register, sdram) = match name.strip_prefix("io")?.split_once("_sd") {
            Some((register, sdram)) => (register, sdram),
            None => (name.strip_prefix("io")?, "0"),
        };
        let waits = Self { register: register.parse().ok()?, sdram: sdram.parse().ok()? };
        Some(waits).filter(|waits| most(&waits.register) && most(&waits.sdram))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wait_states_are_found_by_their_measurement_names() {
        assert_eq!(WaitStates::named("none"), Some(WaitStates::NONE));
        assert_eq!(WaitStates::named("io44"), Some(WaitStates::REGISTERS));
        assert_eq!(WaitStates::named("io44_sd20"), Some(WaitStates { register: 44, sdram: 20 }));
        assert_eq!(WaitStates::named("20"), Some(WaitStates { register: 44, sdram: 20 }));
        for wrong in ["", "io", "io44_sd", "-1", "sd20", "io99999", "none "] {
            assert_eq!(WaitStates::named(wrong), None, "{wrong}");
        }
    }
}
