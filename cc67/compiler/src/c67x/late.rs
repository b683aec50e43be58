//! The cycle after a call in which the function may still write.
//!
//! `sin` and `cos` of the firmware multiply before they know that their angle is so near 0 that it is the result, and
//! return a cycle before that product lands in A7. A packet that wrote A7 in this cycle would do it together with the
//! product, and the processor leaves the value of the register undefined: such a packet is delayed by a cycle.

use super::abi;
use super::packets::Scheduled;

/// Delays the regions after such calls, whose labels are given, where they begin with a result in the register.
pub(super) fn run(regions: &mut [Scheduled], late: &[u32]) {
    for index in 0..regions.len() {
        if late.contains(&regions[index].label) && meets(&regions[index..]) {
            let region = &mut regions[index];
            region.insts.iter_mut().for_each(|issued| issued.cycle += 1);
            region.cycles += 1;
        }
    }
}

/// Reports whether the first cycle writes A7: in the first region, or in those after it that it falls into.
fn meets(regions: &[Scheduled]) -> bool {
    let Some(first) = regions.iter().find(|region| region.cycles > 0) else { return false };
    let issued = first.insts.iter().take_while(|issued| issued.cycle == 0);
    issued.flat_map(|issued| issued.inst.writes()).any(|write| write.reg == abi::LATE && write.stage == 1)
}
