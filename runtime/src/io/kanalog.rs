//! Kanalog's conversions in guest memory: all inputs are converted again in each tick while the board's port serves it.

use chips::fpga::Fpga;
use chips::kanalog::Kanalog;
use kmotiondef::variables::{ADC_BUFFER_IN, KANALOG_PRESENT};
use vm::memory::GuestMemory;

use crate::views::Typed;

/// Converts all inputs, if something is connected to them and the port serves Kanalog.
pub(crate) fn tick(kanalog: &Kanalog, fpga: &Fpga, memory: &mut GuestMemory) {
    if !kanalog.is_driven() || !is_served(fpga, memory) {
        return;
    }
    for (channel, level) in kanalog.conversions().into_iter().enumerate() {
        memory.set(ADC_BUFFER_IN.element(channel), level);
    }
}

/// Returns whether the next tick converts what the last one did.
pub(crate) fn is_settled(kanalog: &Kanalog, fpga: &Fpga, memory: &GuestMemory) -> bool {
    let is_same = |(channel, level): (usize, i32)| memory.get(ADC_BUFFER_IN.element(channel)) == level;
    !kanalog.is_driven()
        || !is_served(fpga, memory)
        || kanalog.conversions().into_iter().enumerate().all(is_same)
}

/// Returns whether the port serves Kanalog: found at power-up, or switched on by the program.
pub(crate) fn is_served(fpga: &Fpga, memory: &GuestMemory) -> bool {
    fpga.serves_kanalog() || memory.get(KANALOG_PRESENT) != 0
}

#[cfg(test)]
mod tests {
    use chips::kanalog::ZERO;

    use super::*;

    #[test]
    fn inputs_are_converted_only_while_kanalog_is_present() {
        let (mut kanalog, fpga, mut memory) = (Kanalog::default(), Fpga::default(), GuestMemory::new());
        memory.set(ADC_BUFFER_IN.element(3), ZERO);
        kanalog.drive(3, 4000);
        for (present, expect) in [(0, ZERO), (1, 4000)] {
            memory.set(KANALOG_PRESENT, present);
            tick(&kanalog, &fpga, &mut memory);
            assert_eq!(memory.get(ADC_BUFFER_IN.element(3)), expect);
        }
    }
}
