//! A view of a stopped processor for people: its registers, and the code around the address.

use std::fmt;

/// Registers in a row of text.
const ROW: usize = 8;

/// Registers and code where the processor has stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scene {
    /// The address of the instruction that did it, or of the packet that should have been next.
    pub at: u32,
    /// Registers by name: A0 to A31, B0 to B31, and the control registers of interest.
    pub registers: Vec<(String, u32)>,
    /// Words around the place: their addresses and their disassembly.
    pub code: Vec<(u32, String)>,
}

/// Prints rows of eight registers, without rows that are all 0; then the code, with a mark at the place.
impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in self.registers.chunks(ROW).filter(|row| row.iter().any(|(_, value)| *value != 0)) {
            let cells = row.iter().map(|(name, value)| format!("{name:>4}={value:08X}"));
            writeln!(f, "  {}", cells.collect::<Vec<_>>().join(" "))?;
        }
        for (at, text) in &self.code {
            let mark = if *at == self.at { '>' } else { ' ' };
            writeln!(f, "{mark} {at:08X}  {text}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_is_marked_and_rows_of_zeros_are_left_out() {
        let register = |index: u32| (format!("A{index}"), if index == 9 { 0x12 } else { 0 });
        let scene = Scene {
            at: 0x8005_0004,
            registers: (0..16).map(register).collect(),
            code: vec![(0x8005_0000, "one".to_owned()), (0x8005_0004, "two".to_owned())],
        };
        assert_eq!(
            scene.to_string(),
            "    A8=00000000   A9=00000012  A10=00000000  A11=00000000  A12=00000000  A13=00000000  A14=00000000  \
             A15=00000000\n  80050000  one\n> 80050004  two\n"
        );
    }
}
