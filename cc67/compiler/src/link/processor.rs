//! The text of a program for the controller's processor.
//!
//! Functions begin at fetch packets, the first at the start of the text. A branch with a displacement has a range of 4
//! MiB: the whole program and the firmware's functions in SDRAM. Functions in on-chip memory are reached by jumps after
//! the program's functions.

use kmotiondef::GuestAddr;

use super::error::{LinkError, LinkErrorKind};
use super::reach::{ReachableParts, Target};
use super::text::{Addresses, TextLayout};
use crate::c67x::ALIGN;
use crate::c67x::text::{branch, far_jump, with_half_constant};
use crate::object::Object;
use crate::relocation::{FixupKind, RelocationKind};
use crate::target;

/// Bytes of a word.
const WORD: u32 = 4;

/// The target of the objects.
pub(super) fn target(objects: &[Object]) -> target::Target {
    objects.first().map_or(target::Target::Sim, Object::target)
}

/// Checks that all objects are for one target.
pub(super) fn check_targets(objects: &[Object]) -> Result<(), Vec<LinkError>> {
    let wanted = target(objects);
    match objects.iter().position(|object| object.target() != wanted) {
        None => Ok(()),
        Some(other) => {
            let kind = LinkErrorKind::OtherTarget;
            Err(vec![LinkError { object: Some(other), span: None, kind, users: Vec::new() }])
        }
    }
}

impl TextLayout {
    /// Lays out the functions that are needed, after them the jumps.
    pub(super) fn processor(&mut self, objects: &[Object], reached: &ReachableParts, base: GuestAddr) {
        self.word_bytes = WORD;
        self.guard = 0;
        let mut word = 0_u32;
        for (object, unit) in objects.iter().enumerate() {
            let needed =
                unit.functions.iter().enumerate().filter(|(index, _)| reached.functions[object][*index]);
            for (index, function) in needed {
                word = word.next_multiple_of(ALIGN);
                self.functions.push((object, index as u32, word));
                word += function.words.end - function.words.start;
            }
        }
        self.words = word;
        for (object, unit) in objects.iter().enumerate() {
            for relocation in &unit.relocations {
                let is_near = relocation.kind == RelocationKind::Processor(FixupKind::Near);
                let address = match &reached.targets[object][relocation.symbol] {
                    Target::Function(address, _) | Target::Variable(address) if is_near => address.get(),
                    _ => continue,
                };
                if !is_in_reach(base.get(), address) && !self.far.contains_key(&address) {
                    self.words = self.words.next_multiple_of(ALIGN);
                    self.far.insert(address, self.words);
                    self.words += far_jump(address).len() as u32;
                }
            }
        }
    }
}

/// Reports whether a branch anywhere in a program at `base` reaches an address.
fn is_in_reach(base: u32, address: u32) -> bool {
    const REACH: u32 = 0x3C_0000;
    base.abs_diff(address) < REACH
}

/// The bytes of the text.
pub(super) fn text(objects: &[Object], layout: &TextLayout, addresses: &Addresses<'_>) -> Vec<u8> {
    let mut words = vec![0_u32; layout.words as usize];
    for (object, index, start) in &layout.functions {
        let unit = &objects[*object];
        let function = &unit.functions[*index as usize];
        let range = function.words.start as usize..function.words.end as usize;
        let own = unit.code.as_deref().and_then(|code| code.get(range)).unwrap_or_default();
        words[*start as usize..*start as usize + own.len()].copy_from_slice(own);
        let relocations = function.relocations.start as usize..function.relocations.end as usize;
        for relocation in &unit.relocations[relocations] {
            let RelocationKind::Processor(kind) = relocation.kind else { continue };
            let target = match &addresses.reached.targets[*object][relocation.symbol] {
                // A function refers to itself without needing itself.
                Target::Unknown => addresses.placed.function((*object, *index)),
                target => addresses.address_of(target),
            };
            let at = start + relocation.word - function.words.start;
            let word = &mut words[at as usize];
            *word = match kind {
                FixupKind::Low(offset) => with_half_constant(*word, target.get().wrapping_add_signed(offset)),
                FixupKind::High(offset) => {
                    with_half_constant(*word, target.get().wrapping_add_signed(offset) >> 16)
                }
                FixupKind::Own(offset) => target.get().wrapping_add_signed(offset),
                FixupKind::Near => {
                    let base = addresses.base.get();
                    let jump = layout.far.get(&target.get()).map(|word| base + word * WORD);
                    branch(*word, base + at * WORD, jump.unwrap_or(target.get()))
                }
            };
        }
    }
    for (address, start) in &layout.far {
        let jump = far_jump(*address);
        words[*start as usize..*start as usize + jump.len()].copy_from_slice(&jump);
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
