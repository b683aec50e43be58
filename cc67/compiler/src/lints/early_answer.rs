//! `persist.UserData[100] = PC_COMM_MSG; if (persist.UserData[103] == IDYES)`: the PC has not answered yet; and
//! `StartThread(2); x = persist.UserData[10];`: the other thread has not run yet. A parameter that is stored after its
//! request, and a request that replaces another one, are related mistakes.
//!
//! Only straight-line code is checked, up to a loop or a call that may wait.

use std::collections::BTreeMap;

use kmotiondef::firmware::Function as FirmwareFunction;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use super::user_data_index::MAILBOX;
use super::user_data_type::element;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{Call, Callee, ExprId, ExprKind, Function, Stmt, StmtKind, SymbolId};

/// The element with the code of a request.
const CODE: i32 = *MAILBOX.start();
/// The parameters that can name other elements.
const NAMES: std::ops::RangeInclusive<i32> = 101..=104;

/// Functions of the board during which no time passes.
const INSTANT: [&str; 4] = [
    FirmwareFunction::printf.name(),
    FirmwareFunction::sprintf.name(),
    FirmwareFunction::Time_sec.name(),
    FirmwareFunction::ReadBit.name(),
];

/// Those of them that print.
const PRINTS: [&str; 2] = [FirmwareFunction::printf.name(), FirmwareFunction::sprintf.name()];

/// Reports answers that are read right after the request, and results of a thread right after it was started.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let mut stores = BTreeMap::new();
    let mut loads = BTreeMap::new();
    for function in program.functions() {
        all_stores(program, function, &mut stores);
        Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
            if let ExprKind::Load(place) = function.exprs[expr].kind
                && let Some(element) = element(program, function, place)
            {
                *loads.entry(element).or_default() += 1;
            }
        });
    }
    let kinds: BTreeMap<_, _> = program
        .functions()
        .filter_map(|function| Some((function.symbol, kind_of(program, function)?)))
        .collect();
    for function in program.functions() {
        let mut own = BTreeMap::new();
        all_stores(program, function, &mut own);
        let mut scan = Scan {
            program,
            function,
            all: &stores,
            own,
            loads: &loads,
            kinds: &kinds,
            since: None,
            late: None,
            prints: false,
            findings: Vec::new(),
        };
        scan.stmts(&function.body);
        scan.findings.into_iter().for_each(|finding| sink.report(finding));
    }
}

/// A function of the program during which no time passes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// It only computes, stores or prints.
    Instant,
    /// It sends a request to the PC, and does not wait for it.
    Posts,
}

/// The kind of a function; `None` if time may pass in it.
fn kind_of(program: &AnalysedProgram<'_>, function: &Function) -> Option<Kind> {
    let mut has_loop = false;
    function
        .each_stmt(&mut |stmt| has_loop |= matches!(stmt.kind, StmtKind::Loop { .. } | StmtKind::Goto(_)));
    let is_instant =
        |call: &Call| called_firmware(program.unit, call).is_some_and(|name| INSTANT.contains(&name));
    if has_loop || !function.calls().all(|(_, call)| is_instant(call)) {
        return None;
    }
    let mut posts = false;
    Walk { function, extent: Extent::Always }.stmts(&function.body, &mut |expr| {
        if let ExprKind::Assign(place, value) = function.exprs[expr].kind {
            posts |= element(program, function, place) == Some(CODE)
                && !matches!(function.exprs[value].kind, ExprKind::Int(..=0));
        }
    });
    Some(if posts { Kind::Posts } else { Kind::Instant })
}

/// The values that are stored in elements of `persist.UserData`: constants, or `None`.
type Stores = BTreeMap<i32, Vec<Option<i64>>>;

fn all_stores(program: &AnalysedProgram<'_>, function: &Function, stores: &mut Stores) {
    Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
        let (place, value) = match &function.exprs[expr].kind {
            ExprKind::Assign(place, value) => match function.exprs[*value].kind {
                ExprKind::Int(number) => (*place, Some(number)),
                _ => (*place, None),
            },
            ExprKind::Update(update) => (update.place, None),
            ExprKind::Address(place) => (*place, None),
            _ => return,
        };
        if let Some(element) = element(program, function, place) {
            stores.entry(element).or_default().push(value);
        }
    });
}

/// A request or start whose answer takes time.
#[derive(Clone, Copy)]
enum Since {
    /// A request to the PC.
    Posted(Span),
    /// A request to the PC, which it may have read.
    Delayed(Span),
    /// The start of a thread.
    Started(Span),
}

struct Scan<'a> {
    program: &'a AnalysedProgram<'a>,
    function: &'a Function,
    /// The stores of the program, and of the function.
    all: &'a Stores,
    own: Stores,
    /// The number of loads of each element in the program.
    loads: &'a BTreeMap<i32, u32>,
    /// The functions of the program during which no time passes.
    kinds: &'a BTreeMap<SymbolId, Kind>,
    since: Option<Since>,
    /// A finding that is reported unless another request follows.
    late: Option<Diagnostic>,
    /// True in an expression that prints.
    prints: bool,
    findings: Vec<Diagnostic>,
}

impl Scan<'_> {
    fn stmts(&mut self, stmts: &[Stmt]) {
        for stmt in stmts {
            match &stmt.kind {
                StmtKind::Expr(expr) => self.expr(*expr),
                StmtKind::Return(Some(value)) => self.expr(*value),
                StmtKind::Block(inner) => self.stmts(inner),
                StmtKind::If { condition, then, otherwise } => {
                    self.expr(*condition);
                    let before = self.since;
                    self.stmts(then);
                    let after = std::mem::replace(&mut self.since, before);
                    self.stmts(otherwise);
                    self.since = self.since.and(after);
                }
                StmtKind::Loop { condition, body, .. } => {
                    // The loop waits for the request, which settles the earlier findings.
                    if let Some(condition) = condition.filter(|_| self.late.is_some()) {
                        self.expr(condition);
                    }
                    self.since = None;
                    self.stmts(body);
                    self.since = None;
                }
                StmtKind::Switch { body, .. } => {
                    self.since = None;
                    self.stmts(body);
                    self.since = None;
                }
                StmtKind::Label(_) => self.since = None,
                _ => {}
            }
        }
    }

    fn expr(&mut self, expr: ExprId) {
        let function = self.function;
        let mut parts = Vec::new();
        Walk { function, extent: Extent::All }.expr(expr, &mut |expr| parts.push(expr));
        self.prints = parts.iter().any(|part| match &function.exprs[*part].kind {
            ExprKind::Call(call) => {
                called_firmware(self.program.unit, call).is_some_and(|name| PRINTS.contains(&name))
            }
            _ => false,
        });
        // A request is posted after its value has been computed.
        parts.sort_by_key(|part| matches!(function.exprs[*part].kind, ExprKind::Assign(..)));
        for part in parts {
            self.part(part);
        }
    }

    fn part(&mut self, part: ExprId) {
        let (program, function) = (self.program, self.function);
        let span = function.exprs[part].span;
        match &function.exprs[part].kind {
            ExprKind::Call(call) => match called_firmware(program.unit, call) {
                Some(name) if name == FirmwareFunction::StartThread.name() => {
                    self.since = Some(Since::Started(span));
                }
                Some(name) if INSTANT.contains(&name) => {}
                Some(name) if name == FirmwareFunction::Delay_sec.name() => self.delay(),
                _ => match self.kind(call) {
                    Some(Kind::Instant) => {}
                    Some(Kind::Posts) => self.posts(span),
                    None => self.since = None,
                },
            },
            ExprKind::Assign(place, value) if element(program, function, *place) == Some(CODE) => {
                self.late = None;
                match function.exprs[*value].kind {
                    ExprKind::Int(..=0) => self.since = None,
                    _ => self.posts(span),
                }
            }
            ExprKind::Assign(place, _) => {
                let stored = element(program, function, *place).filter(|element| MAILBOX.contains(element));
                match (self.since, stored) {
                    (Some(Since::Posted(request)), Some(element)) => {
                        self.findings.push(too_late(element, span, request));
                        self.since = None;
                    }
                    (Some(Since::Delayed(request)), Some(element)) if self.late.is_none() => {
                        self.late = Some(too_late(element, span, request));
                    }
                    _ => {}
                }
            }
            ExprKind::Load(place) => match (self.since, element(program, function, *place)) {
                (_, Some(CODE)) => {
                    self.findings.extend(self.late.take());
                    self.since = None;
                }
                (Some(Since::Posted(request)), Some(element)) if self.is_answer(element) => {
                    self.findings.push(unanswered(element, span, request));
                    self.since = None;
                }
                (Some(Since::Started(start)), Some(element)) if self.is_result(element) => {
                    self.findings.push(not_run(element, span, start));
                    self.since = None;
                }
                _ => {}
            },
            _ => {}
        }
    }

    /// The kind of a called function of the program.
    fn kind(&self, call: &Call) -> Option<Kind> {
        match call.callee {
            Callee::Symbol(callee) => self.kinds.get(&callee).copied(),
            Callee::Pointer(_) => None,
        }
    }

    /// Notes that time passes, in which the PC may have read a request: later stores are parameters of the next
    /// request, or too late.
    fn delay(&mut self) {
        self.since = match self.since {
            Some(Since::Posted(request) | Since::Delayed(request)) => Some(Since::Delayed(request)),
            _ => None,
        };
    }

    /// A request is posted.
    fn posts(&mut self, span: Span) {
        if let Some(Since::Posted(request)) = self.since {
            self.findings.push(replaced(span, request));
        }
        self.since = Some(Since::Posted(span));
    }

    /// Returns whether the PC stores its answer in an element that the function itself at most sets to 0.
    fn is_answer(&self, element: i32) -> bool {
        let only_clears = |stores: &Vec<Option<i64>>| stores.iter().all(|value| *value == Some(0));
        let is_named = || {
            let names = self.own.range(NAMES).flat_map(|(_, values)| values).flatten();
            let element = i64::from(element);
            names.into_iter().any(|name| *name > 0 && (*name == element || 2 * *name == element))
        };
        self.own.get(&element).is_none_or(only_clears) && (MAILBOX.contains(&element) || is_named())
    }

    /// Returns whether an element must be stored by another program: this one only clears or only prints it. Any other
    /// element may be a parameter from the PC.
    fn is_result(&self, element: i32) -> bool {
        let clears = |stores: &Vec<Option<i64>>| stores.iter().all(|value| matches!(value, Some(0 | -1)));
        let is_printed = || self.prints && self.loads.get(&element) == Some(&1);
        !MAILBOX.contains(&element) && self.all.get(&element).map_or_else(is_printed, clears)
    }
}

fn replaced(span: Span, request: Span) -> Diagnostic {
    Diagnostic::warning(Lint::EarlyAnswer, span, "this request to the PC replaces one that it has not read")
        .at("the PC looks every 0.1 s")
        .label(request, "this request is lost")
        .help("wait in between: `while (persist.UserData[100] > 0) WaitNextTimeSlice();`")
}

fn unanswered(element: i32, span: Span, request: Span) -> Diagnostic {
    let message = format!("`persist.UserData[{element}]` is read before the PC has answered");
    Diagnostic::warning(Lint::EarlyAnswer, span, message)
        .at("the value of before")
        .label(request, "the request")
        .help("wait in between: `while (persist.UserData[100] > 0) WaitNextTimeSlice();`")
}

fn too_late(element: i32, span: Span, request: Span) -> Diagnostic {
    let message = format!("`persist.UserData[{element}]` is stored after the request to the PC");
    Diagnostic::warning(Lint::EarlyAnswer, span, message)
        .at("the PC may have read the value of before")
        .label(request, "the request")
        .help("store the parameters first, and the request in `persist.UserData[100]` last")
}

fn not_run(element: i32, span: Span, start: Span) -> Diagnostic {
    let message = format!("`persist.UserData[{element}]` is read before the thread that was started has run");
    Diagnostic::warning(Lint::EarlyAnswer, span, message)
        .at("the value of before")
        .label(start, "the thread begins after the slice of this one")
        .help("let that thread set a flag last, and wait for it: `while (!persist.UserData[…]) WaitNextTimeSlice();`")
}
