//! The accesses of a program in the order of its text.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::ThreadId;
use kmotiondef::firmware::Function as FirmwareCall;
use kmotiondef::map::{IRAM, SDRAM};
use kmotiondef::timing::Timing;
use kmotiondef::variables::USER_CALL_BACK;

use super::Cell;
use super::flow::{Conditions, Guard, Wait};
use super::values::{Pointers, Values};
use crate::ir::function::{Function, Signatures};
use crate::ir::inst::{BlockId, Callee, Constant, Inst, InstKind, Operand};
use crate::ir::operators::{BinaryOp, Width};
use crate::lower::{self, Definitions};
use crate::source::{SourceMap, Span};
use crate::typed::{SymbolId, Unit};

/// The limit of accesses of a program that are analysed.
const MAX_ACCESSES: usize = 4000;

/// The limit of blocks of a function that is analysed: the conditions of each depend on all others.
const MAX_BLOCKS: usize = 500;

/// The deepest chain of calls that is followed.
const MAX_DEPTH: usize = 12;

/// A program of a thread, and its accesses to memory that can be shared.
#[derive(Debug)]
pub(crate) struct ThreadProgram<'a> {
    pub(super) thread: ThreadId,
    pub(super) unit: &'a Unit,
    pub(super) sources: &'a SourceMap,
    pub(super) main: Vec<CellAccess>,
    pub(super) call_back: Vec<CellAccess>,
    /// The loops without a call that wait for a cell.
    pub(super) waits: Vec<Wait>,
}

/// An action on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// It is loaded.
    Load,
    /// It is stored, perhaps always the same value.
    Store(Option<i32>),
    /// A store of a value that was computed from its old value.
    Update(UpdateKind),
    /// A firmware function changes bits of it atomically.
    Change,
    /// A lock is taken.
    Lock,
    /// It is a lock that is freed.
    Unlock,
    /// A thread is started; the cell has no meaning.
    Start(ThreadId),
}

/// The operation that computes a cell's new value from the old one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UpdateKind {
    /// By arithmetic.
    Number,
    /// By `|`, `&` or `^`.
    Bits,
}

/// An access.
#[derive(Clone, Debug)]
pub(super) struct CellAccess {
    pub(super) cell: Cell,
    pub(super) width: Width,
    pub(super) action: Action,
    pub(super) span: Span,
    pub(super) locks: BTreeSet<Cell>,
    pub(super) guards: BTreeSet<Guard>,
    pub(super) is_repeated: bool,
}

impl<'a> ThreadProgram<'a> {
    /// Lists the accesses of a unit without errors.
    pub(crate) fn new(thread: ThreadId, unit: &'a Unit, sources: &'a SourceMap) -> Self {
        let mut signatures = Signatures::default();
        let definitions = Definitions::new(unit, &mut signatures);
        let lower = |function| lower::lower(unit, function, &definitions, Timing::default(), &mut signatures);
        let functions: BTreeMap<_, _> =
            unit.functions.iter().map(lower).map(|function| (function.symbol, function)).collect();
        if functions.values().any(|function| function.layout.len() > MAX_BLOCKS) {
            let (main, call_back, waits) = (Vec::new(), Vec::new(), Vec::new());
            return Self { thread, unit, sources, main, call_back, waits };
        }
        let pointers = Pointers::new(unit, functions.values());
        let mut walk = AccessWalk {
            unit,
            pointers: &pointers,
            functions: &functions,
            call_backs: BTreeSet::new(),
            found: Listed::default(),
            locks: BTreeSet::new(),
            waited: BTreeSet::new(),
        };
        let main = unit.functions.iter().find(|function| unit.symbols[function.symbol].name == "main");
        if let Some(main) = main {
            walk.function(main.symbol, &[], &Caller::default());
        }
        let main = std::mem::take(&mut walk.found);
        for call_back in walk.call_backs.clone() {
            walk.locks.clear();
            walk.waited.clear();
            walk.function(call_back, &[], &Caller::default());
        }
        let call_back = walk.found.accesses;
        Self { thread, unit, sources, main: main.accesses, call_back, waits: main.waits }
    }
}

/// The findings of a walk.
#[derive(Debug, Default)]
struct Listed {
    accesses: Vec<CellAccess>,
    waits: Vec<Wait>,
}

/// The state at a call.
#[derive(Clone, Debug, Default)]
struct Caller {
    guards: BTreeSet<Guard>,
    is_repeated: bool,
    /// The functions that are being executed.
    active: Vec<SymbolId>,
}

/// A walk through a program in the order of its text.
struct AccessWalk<'a> {
    unit: &'a Unit,
    pointers: &'a Pointers,
    functions: &'a BTreeMap<SymbolId, Function>,
    call_backs: BTreeSet<SymbolId>,
    found: Listed,
    locks: BTreeSet<Cell>,
    /// The guards for which functions that have returned have waited.
    waited: BTreeSet<Guard>,
}

impl AccessWalk<'_> {
    fn function(&mut self, symbol: SymbolId, arguments: &[Option<Constant>], caller: &Caller) {
        let Some(function) = self.functions.get(&symbol) else { return };
        if caller.active.contains(&symbol) || caller.active.len() == MAX_DEPTH {
            return;
        }
        let values = Values::new(self.unit, self.pointers, function).with_arguments(function, arguments);
        let conditions = Conditions::new(function, &values);
        let context = |block: BlockId, waited: &BTreeSet<Guard>| Caller {
            guards: caller.guards.iter().chain(waited).copied().chain(conditions.guards(block)).collect(),
            is_repeated: caller.is_repeated || conditions.is_repeated(block),
            active: caller.active.iter().copied().chain([symbol]).collect(),
        };
        self.found.waits.extend(conditions.waits(function, &values));
        for &block in &function.layout {
            for inst in &function.blocks[block].insts {
                if self.found.accesses.len() < MAX_ACCESSES {
                    let here = context(block, &self.waited);
                    self.instruction(function, &values, inst, &here);
                }
            }
        }
        let mut ends = function
            .layout
            .iter()
            .filter(|block| function.blocks[**block].terminator.targets().next().is_none());
        if let Some(end) = ends.next_back() {
            self.waited.extend(conditions.guards(*end));
        }
    }

    fn instruction(&mut self, function: &Function, values: &Values<'_>, inst: &Inst, here: &Caller) {
        let span = inst.origin.span;
        match inst.kind {
            InstKind::Load { width, address, .. } => {
                let cell = values.cell(address);
                self.note(cell, width, Action::Load, span, here);
            }
            InstKind::Store { src, width, address } => {
                let Some(cell) = values.cell(address) else { return };
                if cell == Cell::Board(USER_CALL_BACK.address().get())
                    && let Some(Constant::Symbol(function, _)) = values.constant(src)
                {
                    self.call_backs.insert(function);
                }
                let action = match values.constant(src) {
                    Some(Constant::I32(value)) => Action::Store(Some(value)),
                    _ if values.loads(src).contains(&cell) => Action::Update(update_kind(values, src)),
                    _ => Action::Store(None),
                };
                self.note(Some(cell), width, action, span, here);
                if action == Action::Store(Some(0)) {
                    self.locks.remove(&cell);
                }
            }
            InstKind::Call { callee: Callee::Symbol(callee), arguments, .. } => {
                let arguments = function.arguments.get(arguments.range()).unwrap_or_default();
                let arguments: Vec<_> = arguments.iter().map(|argument| values.constant(*argument)).collect();
                self.call(values, callee, &arguments, span, here);
            }
            InstKind::Call { callee: Callee::Pointer(_), .. }
            | InstKind::Copy { .. }
            | InstKind::Unary { .. }
            | InstKind::Binary { .. }
            | InstKind::Compare { .. }
            | InstKind::Convert { .. }
            | InstKind::FrameAddress { .. }
            | InstKind::CopyMemory { .. }
            | InstKind::ClearMemory { .. }
            | InstKind::Cost { .. } => {}
        }
    }

    fn call(
        &mut self,
        values: &Values<'_>,
        callee: SymbolId,
        arguments: &[Option<Constant>],
        span: Span,
        here: &Caller,
    ) {
        if self.functions.contains_key(&callee) {
            return self.function(callee, arguments, here);
        }
        let first = arguments.first().copied().flatten();
        let cell = first.and_then(|first| values.cell_of(first));
        let name = &self.unit.symbols[callee].name;
        let called = FirmwareCall::ALL.iter().find(|function| function.name() == name);
        match called {
            Some(FirmwareCall::MutexLock | FirmwareCall::TestAndSet) => {
                self.note(cell, Width::I32, Action::Lock, span, here);
                self.locks.extend(cell);
            }
            Some(FirmwareCall::MutexUnlock) => {
                self.note(cell, Width::I32, Action::Unlock, span, here);
                self.locks.retain(|lock| Some(*lock) != cell);
            }
            Some(FirmwareCall::AtomicSet | FirmwareCall::AtomicClear) => {
                self.note(cell, Width::I32, Action::Change, span, here);
            }
            Some(FirmwareCall::StartThread) => {
                if let Some(Constant::I32(number)) = first
                    && let Some(thread) = ThreadId::new(number)
                {
                    self.found.accesses.push(self.access(
                        Cell::Board(0),
                        Width::I32,
                        Action::Start(thread),
                        span,
                        here,
                    ));
                }
            }
            _ => {}
        }
    }

    fn note(&mut self, cell: Option<Cell>, width: Width, action: Action, span: Span, here: &Caller) {
        let is_memory = |cell: &Cell| match *cell {
            Cell::Board(address) => {
                [SDRAM, IRAM].iter().any(|region| address.wrapping_sub(region.base.get()) < region.size)
            }
            Cell::Variable(..) => true,
        };
        if let Some(cell) = cell.filter(is_memory) {
            self.found.accesses.push(self.access(cell, width, action, span, here));
        }
    }

    fn access(&self, cell: Cell, width: Width, action: Action, span: Span, here: &Caller) -> CellAccess {
        let (locks, guards) = (self.locks.clone(), here.guards.clone());
        CellAccess { cell, width, action, span, locks, guards, is_repeated: here.is_repeated }
    }
}

fn update_kind(values: &Values<'_>, src: Operand) -> UpdateKind {
    let write = src.as_value().and_then(|value| values.only_write(value));
    let is_of_bits =
        matches!(write, Some(InstKind::Binary { op: BinaryOp::And | BinaryOp::Or | BinaryOp::Xor, .. }));
    if is_of_bits { UpdateKind::Bits } else { UpdateKind::Number }
}
