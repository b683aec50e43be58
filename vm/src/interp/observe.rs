//! Accesses to memory that threads can share, reported to the firmware.
//!
//! A load or store through a register tests its address before it is executed; a constant address is tested once. An
//! instruction with a shared access leaves the fast execution, is executed as a single step and reported; the results
//! stay the same.

use std::sync::Arc;

use kmotiondef::{CodeAddr, GuestAddr};

use super::context::Context;
use crate::engine::{ContextId, ObservedAccesses, Slice};
use crate::filter::{AccessFilter, PageOwners};
use crate::firmware::{Firmware, NextAccess, RepeatPolicy, SharedAccess, SwitchPoint};
use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Addr, Count, Off, RegI32};
use crate::program::Program;
use crate::shared::{is_noticed, loads_of, loads_together, registers};

/// The form of an access's address.
#[derive(Clone, Copy, Debug)]
pub(super) enum AccessPlace {
    /// All.
    Constant(u32),
    /// In a register, plus a displacement.
    Register,
    /// In a register, for a block that is copied or cleared.
    Block,
}

/// The place that an instruction accesses.
pub(super) fn place_of(op: &Op) -> Option<AccessPlace> {
    match op.kind() {
        OpKind::Load(_) | OpKind::Store(_) => Some(
            op.operand(Name::Addr)
                .map_or(AccessPlace::Register, |Addr(address)| AccessPlace::Constant(address)),
        ),
        OpKind::Block => Some(AccessPlace::Block),
        OpKind::Structure
        | OpKind::Charge
        | OpKind::Constant
        | OpKind::Move
        | OpKind::Address
        | OpKind::Arithmetic
        | OpKind::Negation
        | OpKind::Conversion
        | OpKind::Jump
        | OpKind::Branch
        | OpKind::Table
        | OpKind::Argument(_)
        | OpKind::Call
        | OpKind::Result(_)
        | OpKind::Return(_)
        | OpKind::Stop => None,
    }
}

/// A part of an access that is about to be made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AccessPart {
    pub(crate) address: GuestAddr,
    /// Number of bytes.
    pub(crate) size: u32,
    pub(crate) is_store: bool,
}

/// The parts of an access: two for a block copy, otherwise one.
pub(super) type AccessParts = [Option<AccessPart>; 2];

/// The accesses that the current instruction of `context` is about to make.
pub(super) fn accesses(op: &Op, context: &Context) -> AccessParts {
    let pointer = |name| op.operand::<RegI32>(name).map(|register| context.get(register.0) as u32);
    let part = |address, size, is_store| AccessPart { address: GuestAddr::new(address), size, is_store };
    let one = |address: u32| op.kind().width().map(|width| part(address, width.bytes(), is_store(op)));
    match place_of(op) {
        None => [None; 2],
        Some(AccessPlace::Block) => {
            let len = op.operand::<Count>(Name::Len).map_or(0, |Count(len)| len.into());
            [(Name::Src, false), (Name::To, true)]
                .map(|(name, is_store)| Some(part(pointer(name)?, len, is_store)))
        }
        Some(AccessPlace::Constant(address)) => [one(address), None],
        Some(AccessPlace::Register) => {
            let address = op.operand(Name::Off).zip(pointer(Name::Base));
            let address = address.map(|(Off(off), base)| base.wrapping_add_signed(off.into()));
            [address.and_then(one), None]
        }
    }
}

/// Facts about the text of programs, computed when first needed.
#[derive(Debug, Default)]
pub(crate) struct Observer {
    /// True if all accesses are reported, including redundant ones.
    reports_all: bool,
    /// The contexts that are the only users of pages of SDRAM.
    owners: Arc<PageOwners>,
    /// The programs, by their start.
    programs: Vec<(GuestAddr, ProgramFacts)>,
}

/// Facts about the text of a program.
#[derive(Debug)]
struct ProgramFacts {
    /// True if it shares its own data with a call-back.
    has_call_back: bool,
    /// By word, the loads on which the stored value depends, or with which the loaded value is used; `None` until they
    /// are needed.
    loads: Vec<Option<Box<[CodeAddr]>>>,
}

impl ProgramFacts {
    fn of(program: &Program) -> Self {
        Self { has_call_back: program.has_call_back(), loads: vec![None; program.ops().len()] }
    }

    /// Returns the loads on which the stored value of `word` depends, or with which its loaded value is used.
    fn loads_at(&mut self, program: &Program, word: usize, is_store: bool) -> &[CodeAddr] {
        if self.loads.get(word).is_some_and(Option::is_none) {
            self.find_loads(program, word, is_store);
        }
        self.loads.get(word).and_then(Option::as_deref).unwrap_or_default()
    }

    fn find_loads(&mut self, program: &Program, word: usize, is_store: bool) {
        if is_store {
            self.loads[word] = Some(loads_of(program, word).into());
            return;
        }
        let function = program.function_around(word);
        for (at, loads) in function.map(|function| loads_together(program, function)).unwrap_or_default() {
            if let Some(place) = program.word_at(at).and_then(|word| self.loads.get_mut(word)) {
                *place = Some(loads.into_iter().collect());
            }
        }
        self.loads[word].get_or_insert_default();
    }
}

/// An access that is about to be made.
#[derive(Debug)]
pub(super) struct Pending {
    op: Op,
    word: usize,
    parts: AccessParts,
    /// The stored value.
    stored: u64,
}

/// An access that a context has made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CompletedAccess {
    /// The instruction.
    pub(crate) word: usize,
    pub(crate) part: AccessPart,
    /// The value as a register slot; 0 for the copy of a block.
    pub(crate) value: u64,
}

impl Observer {
    /// The observer of accesses, if any is reported.
    pub(crate) fn new(observed: ObservedAccesses) -> Option<Self> {
        match observed {
            ObservedAccesses::None => None,
            ObservedAccesses::Fresh => Some(Self::default()),
            ObservedAccesses::All => Some(Self { reports_all: true, ..Self::default() }),
        }
    }

    /// Returns whether all accesses are reported.
    pub(crate) const fn reports_all(&self) -> bool {
        self.reports_all
    }

    /// The access filter of a new context; `None` if all accesses are reported.
    pub(super) fn filter(&self, context: ContextId) -> Option<Box<AccessFilter>> {
        (!self.reports_all).then(|| Box::new(AccessFilter::with_owners(&self.owners, context)))
    }

    /// The owners of pages.
    pub(crate) const fn owners(&self) -> &Arc<PageOwners> {
        &self.owners
    }

    /// An observer of other contexts of the same machine.
    #[cfg(feature = "native")]
    pub(crate) fn for_other_contexts(&self) -> Self {
        Self { reports_all: self.reports_all, owners: Arc::clone(&self.owners), ..Self::default() }
    }

    /// Drops all knowledge of programs.
    pub(crate) fn clear(&mut self) {
        let owners = Arc::clone(&self.owners);
        *self = Self { reports_all: self.reports_all, owners, ..Self::default() };
    }

    /// The facts about a program.
    fn facts(&mut self, program: &Program) -> &mut ProgramFacts {
        let base = program.base();
        let place = self.programs.iter().position(|(start, _)| *start == base);
        let place = place.unwrap_or_else(|| {
            self.programs.push((base, ProgramFacts::of(program)));
            self.programs.len() - 1
        });
        &mut self.programs[place].1
    }

    /// The access that the current instruction of `context` is about to make, if it is reported.
    pub(super) fn about_to(&mut self, program: &Program, context: &Context) -> Option<Pending> {
        let word = context.calls.pc;
        let op = *program.ops().get(word)?;
        place_of(&op)?;
        let has_call_back = self.facts(program).has_call_back;
        let is_block = op.kind() == OpKind::Block;
        let known = |part: &AccessPart| {
            !is_block && context.filter.as_ref().is_some_and(|filter| filter.knows(word, part.address.get()))
        };
        let parts = accesses(&op, context)
            .map(|part| part.filter(|part| !known(part) && is_noticed(part.address.get(), has_call_back)));
        if parts.iter().all(Option::is_none) {
            return None;
        }
        let stored = registers(&op).sources.first().map_or(0, |register| context.get(*register));
        Some(Pending { op, word, parts, stored })
    }

    /// Reports an access that has been made, if it is observed.
    pub(crate) fn report<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Program,
        CompletedAccess { word, part, value }: CompletedAccess,
        filter: Option<&AccessFilter>,
        slice: &mut Slice<'_, F>,
    ) {
        let AccessPart { address, size, is_store } = part;
        let is_private = !self.reports_all && self.owners.claim(id, address, size);
        let facts = self.facts(program);
        if is_private || !is_noticed(address.get(), facts.has_call_back) {
            return;
        }
        let (thread, at, now) = (id.thread(), program.address_of(word), slice.now());
        let made_of = facts.loads_at(program, word, is_store);
        let access = SharedAccess { thread, at, address, size, is_store, value, made_of, now };
        let repeats = slice.firmware.accessed(&access, slice.memory);
        let Some(filter) = filter else { return };
        if slice.firmware.take_ordering() {
            filter.clear();
        } else if repeats == RepeatPolicy::Redundant && size <= 8 {
            filter.note(word, address.get());
        }
    }
}

impl Pending {
    /// The point at which the thread loses the processor there, if it does.
    pub(super) fn switch_at<F: Firmware + ?Sized>(
        &self,
        id: ContextId,
        program: &Program,
        slice: &mut Slice<'_, F>,
    ) -> Option<SwitchPoint> {
        let (thread, part) = (id.thread()?, self.parts.into_iter().flatten().next()?);
        let AccessPart { address, size, is_store } = part;
        let (at, now) = (program.address_of(self.word), slice.now());
        slice.firmware.switch_at(&NextAccess { thread, at, address, size, is_store, now })
    }

    /// Reports the access after it has been made.
    pub(super) fn report<F: Firmware + ?Sized>(
        &self,
        id: ContextId,
        program: &Program,
        context: &Context,
        observer: &mut Observer,
        slice: &mut Slice<'_, F>,
    ) {
        let Self { op, word, parts, stored } = self;
        let value = if op.kind() == OpKind::Block {
            0
        } else if is_store(op) {
            *stored
        } else {
            registers(op).assigned.map_or(0, |register| context.get(register))
        };
        for part in parts.iter().flatten().copied() {
            observer.report(
                id,
                program,
                CompletedAccess { word: *word, part, value },
                context.filter.as_deref(),
                slice,
            );
        }
    }
}

fn is_store(op: &Op) -> bool {
    matches!(op.kind(), OpKind::Store(_))
}
