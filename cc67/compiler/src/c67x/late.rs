//! The cycle after a call in which a result of the callee may still land.
//!
//! `sin` and `cos` of the firmware start a multiplication before they detect that the angle is close enough to 0 to be
//! the result itself, and return a cycle before the product lands in A7. If a packet wrote A7 in this cycle, too, the
//! value of the register would be undefined: such a packet is delayed by a cycle.

use super::abi;
use super::packets::ScheduledRegion;

/// Delays the regions with the given labels, after such calls, if they begin with a result in the register.
pub(super) fn run(regions: &mut [ScheduledRegion], late: &[u32]) {
    for index in 0..regions.len() {
        if late.contains(&regions[index].label) && meets(&regions[index..]) {
            let region = &mut regions[index];
            region.insts.iter_mut().for_each(|issued| issued.cycle += 1);
            region.cycles += 1;
        }
    }
}

/// Reports whether the first cycle writes A7: in the first region, or in the following ones if it falls through.
fn meets(regions: &[ScheduledRegion]) -> bool {
    let Some(first) = regions.iter().find(|region| region.cycles > 0) else { return false };
    let issued = first.insts.iter().take_while(|issued| issued.cycle == 0);
    issued.flat_map(|issued| issued.inst.writes()).any(|write| write.reg == abi::LATE && write.stage == 1)
}
