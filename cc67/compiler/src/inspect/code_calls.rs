//! The call graph of the processor's code.

use std::collections::BTreeSet;

use c67x::{Op, Operand};

use super::Inspection;
use super::calls::{Calls, Node, firmware_name};
use super::machine::{self, CallTarget, Routine};
use crate::c67x::text::constant;

impl Calls {
    /// The functions of an image for the processor.
    ///
    /// # Errors
    /// The reason why its code is unknown.
    pub(super) fn of_code(inspection: &Inspection) -> Result<Self, String> {
        let routines = machine::functions(inspection)?;
        let taken = addresses_taken(inspection, &routines);
        let nodes = routines.iter().map(|code| node(inspection, &routines, code, &taken));
        Ok(Self { nodes: nodes.collect() })
    }
}

fn node(inspection: &Inspection, routines: &[Routine], code: &Routine, taken: &BTreeSet<usize>) -> Node {
    let mut node = Node {
        name: code.name.clone(),
        address: code.address,
        frame: super::frames::max_frame_depth(code),
        calls: BTreeSet::new(),
        through_pointers: BTreeSet::new(),
        calls_pointers: false,
        firmware: BTreeSet::new(),
    };
    for call in code.blocks.iter().filter_map(|block| block.call) {
        match call {
            CallTarget::At(address) => {
                let address = machine::resolve_trampoline(&inspection.image, address);
                match routine_index(routines, address) {
                    Some(index) => drop(node.calls.insert(index)),
                    None => drop(node.firmware.insert(firmware_name(inspection, address))),
                }
            }
            CallTarget::Pointer => {
                node.calls_pointers = true;
                node.through_pointers.extend(taken);
            }
        }
    }
    node
}

fn routine_index(routines: &[Routine], address: u32) -> Option<usize> {
    routines.iter().position(|code| code.address == address)
}

/// The functions whose addresses are used as values: in data, or in code other than calls.
fn addresses_taken(inspection: &Inspection, routines: &[Routine]) -> BTreeSet<usize> {
    let data = inspection.image.sections.iter().filter(|section| section.name != *".text");
    let words =
        data.flat_map(|section| section.data().as_chunks::<4>().0).map(|word| u32::from_le_bytes(*word));
    let mut taken: BTreeSet<usize> = words.filter_map(|word| routine_index(routines, word)).collect();
    for code in routines {
        let called =
            |address| code.blocks.iter().filter(|block| block.call == Some(CallTarget::At(address))).count();
        let constants = constants(code);
        for address in &constants {
            let uses = constants.iter().filter(|other| *other == address).count();
            taken.extend(routine_index(routines, *address).filter(|_| uses > called(*address)));
        }
    }
    taken
}

/// The numbers built by `MVK` and `MVKH`, in the order of the code.
fn constants(code: &Routine) -> Vec<u32> {
    let mut low = [None; 64];
    let mut found = Vec::new();
    for inst in code.packets.iter().flat_map(|packet| &packet.insts) {
        let Some(Operand::Reg(reg)) = inst.operands().last() else { continue };
        let half = constant(inst.encode(false));
        if inst.op() == Op::Mvk {
            low[reg.index()] = Some(half);
        } else if inst.op() == Op::Mvkh {
            found.extend(low[reg.index()].map(|low| half << 16 | low));
        }
    }
    found
}
