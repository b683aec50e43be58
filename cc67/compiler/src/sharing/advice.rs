//! Pairs of accesses that can go wrong, as far as the source shows.

use std::collections::BTreeSet;

use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::{CHAN, PERSIST, USER_CALL_BACK, cell_name, variable_around};
use kmotiondef::{GuestAddr, ThreadId};

use super::Cell;
use super::accesses::{Action, CellAccess, ThreadProgram, UpdateKind};
use super::flow::{Guard, Wait};
use crate::diag::{Diagnostic, Lint};
use crate::ir::operators::Width;
use crate::lints::user_data_index::is_of_the_pc;
use crate::typed::SymbolId;

/// The reference to further information.
const MORE: &str = "`cc67 explain races` has the ways that are right on the board";

/// The context that executes accesses.
#[derive(Clone, Copy, Debug)]
struct SharingContext<'a> {
    program: &'a ThreadProgram<'a>,
    accesses: &'a [CellAccess],
    is_call_back: bool,
}

/// The advice about a program and its call-back.
pub(crate) fn report_call_back_sharing(program: &ThreadProgram<'_>) -> Vec<Diagnostic> {
    let [main, call_back] = contexts(program);
    lost_updates(main, call_back).chain(torn_doubles(main, call_back)).collect()
}

/// The advice for one of several programs about the memory that it shares with the others; if two programs both change
/// a cell, the advice is given for the one in the lower thread.
pub(crate) fn advise(program: &ThreadProgram<'_>, programs: &[ThreadProgram<'_>]) -> Vec<Diagnostic> {
    let [main, call_back] = contexts(program);
    let others = programs.iter().filter(|other| other.thread != program.thread);
    let found = others.flat_map(contexts).flat_map(|theirs| {
        lost_updates(main, theirs)
            .chain(torn_doubles(main, theirs))
            .chain(early_flags(main, theirs))
            .chain(other_types(main, theirs))
    });
    // The board's own compilers read memory each time; this is for other ones.
    found.chain(not_volatile(main, call_back)).collect()
}

fn contexts<'a>(program: &'a ThreadProgram<'a>) -> [SharingContext<'a>; 2] {
    [
        SharingContext { program, accesses: program.main.as_slice(), is_call_back: false },
        SharingContext { program, accesses: program.call_back.as_slice(), is_call_back: true },
    ]
}

/// Statements of `ours` whose load and store can be interrupted by `theirs`.
fn lost_updates<'a>(
    ours: SharingContext<'a>,
    theirs: SharingContext<'a>,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let mut seen = BTreeSet::new();
    let is_told = theirs.program.thread < ours.program.thread && !theirs.is_call_back;
    let updates = ours.accesses.iter().enumerate().filter_map(|(number, access)| match access.action {
        Action::Update(kind) => Some((number, access, kind)),
        _ => None,
    });
    updates.filter_map(move |(number, access, kind)| {
        let mut others = theirs.accesses.iter().enumerate().filter(|(_, other)| {
            let is_change = match other.action {
                Action::Update(_) => !is_told,
                Action::Store(_) | Action::Change => true,
                Action::Load | Action::Lock | Action::Unlock | Action::Start(_) => false,
            };
            is_change && is_same(ours, access, theirs, other)
        });
        let (_, other) = others.find(|(place, _)| is_conflict(ours, number, theirs, *place))?;
        seen.insert(access.cell).then(|| lost_update((ours, access, kind), (theirs, other)))
    })
}

fn lost_update(
    (ours, access, kind): (SharingContext<'_>, &CellAccess, UpdateKind),
    (theirs, other): (SharingContext<'_>, &CellAccess),
) -> Diagnostic {
    let cell = name(ours.program, access);
    let effect = match other.action {
        Action::Update(_) | Action::Change => "an update can be lost",
        Action::Store(_) | Action::Load | Action::Lock | Action::Unlock | Action::Start(_) => {
            "a store in between is wiped out"
        }
    };
    let message = format!(
        "{cell} is changed by a load and a store, and {} changes it too: {effect}",
        who(theirs, other)
    );
    let help = match (theirs.is_call_back, kind) {
        (true, _) => {
            "let only one of them change it (two cells, of which each changes one); a call-back must not wait for a lock"
        }
        (false, UpdateKind::Bits) => "change bits with AtomicSet and AtomicClear",
        (false, UpdateKind::Number) => "hold the same lock at both places (MutexLock, MutexUnlock)",
    };
    Diagnostic::warning(Lint::Races, access.span, message).help(help).note(MORE)
}

/// Stores of eight bytes in `ours` that `theirs` can read half old.
fn torn_doubles<'a>(
    ours: SharingContext<'a>,
    theirs: SharingContext<'a>,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let mut seen = BTreeSet::new();
    let stores = ours.accesses.iter().enumerate().filter(|(_, access)| {
        access.width.bytes() == 8
            && matches!(access.action, Action::Store(_) | Action::Update(_))
            && !is_of_axis(access.cell)
    });
    stores.filter_map(move |(number, access)| {
        let same = ours.accesses.iter().filter(|other| {
            other.cell == access.cell && matches!(other.action, Action::Store(_) | Action::Update(_))
        });
        if !access.is_repeated && same.count() < 2 {
            return None;
        }
        let mut loads = theirs.accesses.iter().enumerate().filter(|(_, other)| {
            other.width.bytes() == 8 && other.action == Action::Load && is_same(ours, access, theirs, other)
        });
        let (_, other) = loads.find(|(place, _)| {
            is_conflict(ours, number, theirs, *place) && !comes_before(ours, number, theirs, *place)
        })?;
        seen.insert(access.cell).then(|| {
            let (cell, who) = (name(ours.program, access), who(theirs, other));
            let message = format!("the eight bytes of {cell} are stored as two words, and {who} loads them: half of the value can be old");
            Diagnostic::warning(Lint::Races, access.span, message)
                .help("hold the same lock at both places, or set a flag after the value and read the flag first")
                .note(MORE)
        })
    })
}

/// Flags of `ours` that are set before the value which `theirs` reads once it has seen the flag.
fn early_flags<'a>(
    ours: SharingContext<'a>,
    theirs: SharingContext<'a>,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let mut seen = BTreeSet::new();
    let is_store = |access: &CellAccess| matches!(access.action, Action::Store(_) | Action::Update(_));
    ours.accesses.iter().enumerate().filter_map(move |(number, flag)| {
        let Action::Store(Some(set)) = flag.action else { return None };
        let sets_flag = |access: &CellAccess| access.cell == flag.cell && is_store(access);
        // What is done until the flag is looked at or set again belongs to it.
        let after = &ours.accesses[number + 1..];
        let end = after.iter().position(|access| access.cell == flag.cell).unwrap_or(after.len());
        if after[end..].iter().any(sets_flag) {
            return None;
        }
        let value = after[..end].iter().find(|value| {
            let is_first = !ours.accesses[..number].iter().any(|one| one.cell == value.cell && is_store(one));
            is_store(value) && is_first && value.locks.intersection(&flag.locks).next().is_none()
        })?;
        let read = theirs.accesses.iter().find(|read| {
            let tests_flag =
                |guard: &Guard| guard.cell == flag.cell && guard.is_simple() && guard.admits(Some(set));
            read.action == Action::Load
                && is_same(ours, value, theirs, read)
                && read.guards.iter().any(tests_flag)
        })?;
        seen.insert(flag.cell).then(|| {
            let (flag_name, value_name) = (name(ours.program, flag), name(ours.program, value));
            let message = format!(
                "{flag_name} is set before {value_name}, which {} reads once it has seen the flag: it can read the old value",
                who(theirs, read)
            );
            Diagnostic::warning(Lint::Races, flag.span, message)
                .label(value.span, "the value is stored here")
                .help("store the value first, and set the flag after it")
                .note(MORE)
        })
    })
}

/// Elements of `persist.UserData` that `ours` only reads as one type, and `theirs` only stores as the other.
fn other_types<'a>(
    ours: SharingContext<'a>,
    theirs: SharingContext<'a>,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let mut seen = BTreeSet::new();
    ours.accesses.iter().filter_map(move |read| {
        let is_single = match read.width {
            Width::F32 => true,
            Width::I32 => false,
            _ => return None,
        };
        let is_other = |store: &CellAccess| {
            let other = if is_single { Width::I32 } else { Width::F32 };
            // All bits of a 0 are 0, and a constant may be a flag.
            matches!(store.action, Action::Store(None)) && store.width == other
        };
        let is_it = |access: &&CellAccess| access.cell == read.cell;
        let only_reads = ours.accesses.iter().filter(is_it).all(|access| access.action == Action::Load);
        let mut stores = theirs.accesses.iter().filter(is_it).filter(|access| access.action != Action::Load);
        let store = stores.next().filter(|store| is_other(store) && stores.all(is_other))?;
        let is_read = read.action == Action::Load && only_reads && is_element(read.cell);
        (is_read && is_same(ours, read, theirs, store) && seen.insert(read.cell)).then(|| {
            let cell = name(ours.program, read);
            let (read_as, stored, help) = match is_single {
                true => ("a `float`", "an integer", cell.clone()),
                false => ("an integer", "a `float`", format!("*(float *)&{cell}")),
            };
            let message =
                format!("{cell} is read as {read_as}, and {} stores {stored} there", who(theirs, store));
            Diagnostic::warning(Lint::UserDataType, read.span, message)
                .at("the bits of the other type")
                .help(format!("read `{help}`, or store the other type"))
        })
    })
}

/// Returns whether a cell is an element of `persist.UserData` for programs.
fn is_element(cell: Cell) -> bool {
    let Cell::Board(address) = cell else { return false };
    let first = PERSIST.field(Persist::USER_DATA).address().get();
    let index = address.wrapping_sub(first) / 4;
    index < N_USER_DATA_VARS as u32 && !is_of_the_pc(index.cast_signed())
}

/// Variables that a loop of `main` without a call waits for, that the call-back stores and that are not `volatile`.
fn not_volatile<'a>(
    main: SharingContext<'a>,
    call_back: SharingContext<'a>,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let mut seen = BTreeSet::new();
    main.program.waits.iter().filter_map(move |Wait { cell, span }| {
        let Cell::Variable(symbol, _) = *cell else { return None };
        let is_stored = |access: &CellAccess| {
            access.cell == *cell && matches!(access.action, Action::Store(_) | Action::Update(_))
        };
        let store = call_back.accesses.iter().find(|access| is_stored(access))?;
        let is_volatile = is_declared_volatile(main.program, symbol);
        (!is_volatile && seen.insert(symbol)).then(|| {
            let name = &main.program.unit.symbols[symbol].name;
            let message = format!("this loop waits for `{name}`, which {} stores, but the variable is not `volatile`: an optimising compiler may read it only once", who(call_back, store));
            Diagnostic::warning(Lint::Races, *span, message).help(format!("declare it as `volatile … {name}`"))
        })
    })
}

/// Returns whether the declaration of a variable has `volatile`.
fn is_declared_volatile(program: &ThreadProgram<'_>, symbol: SymbolId) -> bool {
    let span = program.unit.symbols[symbol].span;
    let Some(file) = program.sources.file_at(span.lo) else { return true };
    let file = program.sources.file(file);
    let before = file.text.get(..(span.hi - file.start) as usize).unwrap_or_default();
    let start = before.iter().rposition(|byte| b";{}".contains(byte)).unwrap_or(0);
    memchr::memmem::find(&before[start..], b"volatile").is_some()
}

/// Returns whether two accesses are of the same cell, which both contexts can reach.
fn is_same(
    ours: SharingContext<'_>,
    access: &CellAccess,
    theirs: SharingContext<'_>,
    other: &CellAccess,
) -> bool {
    let is_own = ours.program.thread == theirs.program.thread;
    access.cell == other.cell && (is_own || matches!(access.cell, Cell::Board(_)))
}

/// Returns whether nothing orders two accesses.
fn is_conflict(ours: SharingContext<'_>, number: usize, theirs: SharingContext<'_>, place: usize) -> bool {
    let (access, other) = (&ours.accesses[number], &theirs.accesses[place]);
    if access.locks.intersection(&other.locks).next().is_some() {
        return false;
    }
    if theirs.is_call_back && theirs.program.thread == ours.program.thread && !is_called_back(ours, number) {
        return false;
    }
    if access.guards.iter().any(|guard| other.guards.iter().any(|other| guard.excludes(other))) {
        return false;
    }
    let (first, second) =
        (comes_before(ours, number, theirs, place), comes_before(theirs, place, ours, number));
    let is_ordered = match (first, second) {
        (true, true) => true,
        (true, false) => !access.is_repeated,
        (false, true) => !other.is_repeated,
        (false, false) => false,
    };
    !is_ordered
}

/// Returns whether the access `number` of `one` is complete when `other` reaches `place`: because `one` then stores a
/// flag that `other` has tested, or starts `other`.
fn comes_before(one: SharingContext<'_>, number: usize, other: SharingContext<'_>, place: usize) -> bool {
    let cell = one.accesses[number].cell;
    let guards = &other.accesses[place].guards;
    one.accesses[number..].iter().any(|later| match later.action {
        Action::Start(thread) => thread == other.program.thread && !other.is_call_back,
        Action::Store(value) => {
            later.cell != cell && guards.iter().any(|guard| guard.cell == later.cell && guard.admits(value))
        }
        Action::Update(_) => later.cell != cell && guards.iter().any(|guard| guard.cell == later.cell),
        Action::Load | Action::Change | Action::Lock | Action::Unlock => false,
    })
}

/// Returns whether the call-back is set when a program makes an access.
fn is_called_back(main: SharingContext<'_>, number: usize) -> bool {
    let cell = Cell::Board(USER_CALL_BACK.address().get());
    let sets: Vec<_> = main
        .accesses
        .iter()
        .enumerate()
        .filter(|(_, access)| access.cell == cell && matches!(access.action, Action::Store(_)))
        .collect();
    let before = sets.iter().rev().find(|(place, _)| *place < number);
    match before {
        Some((_, access)) => access.action != Action::Store(Some(0)),
        // A loop may get here again.
        None => {
            sets.is_empty()
                || main.accesses[number].is_repeated && sets.iter().any(|(_, set)| set.is_repeated)
        }
    }
}

/// Returns whether a cell is of an axis, of which readers take the newest value.
fn is_of_axis(cell: Cell) -> bool {
    let Cell::Board(address) = cell else { return false };
    variable_around(GuestAddr::new(address)).is_some_and(|variable| variable.address == CHAN.address())
}

/// Returns the name of a cell in the source.
fn name(program: &ThreadProgram<'_>, access: &CellAccess) -> String {
    match access.cell {
        Cell::Board(address) => cell_name(GuestAddr::new(address), access.width.bytes()),
        Cell::Variable(symbol, 0) => program.unit.symbols[symbol].name.clone(),
        Cell::Variable(symbol, offset) => format!("{} + {offset}", program.unit.symbols[symbol].name),
    }
}

/// Returns the context of an access, and its place.
fn who(context: SharingContext<'_>, access: &CellAccess) -> String {
    let ThreadProgram { thread, sources, .. } = context.program;
    let place = sources.place(access.span).map_or_else(String::new, |place| {
        format!(" at {}:{}:{}", sources.file(place.file).name, place.line, place.column)
    });
    if context.is_call_back {
        format!("the call-back{place}")
    } else {
        format!("thread {}{place}", ThreadId::get(*thread))
    }
}
