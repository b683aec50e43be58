//! `if (MsgBox(text, MB_YESNO) == 1)`: the button *Yes* is `IDYES`, 6, and *No* is not 0.

use std::collections::BTreeMap;

use super::program::AnalysedProgram;
use super::user_data_type::element;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::source::Span;
use crate::typed::{
    Call, Callee, ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, StmtKind, SymbolId, UnaryOp,
};

/// The elements of `persist.UserData` with the flags of a message box and with its answer.
const FLAGS: i32 = 102;
const ANSWER: i32 = 103;

/// The buttons of a message box.
#[derive(Clone, Copy)]
struct Buttons {
    /// The flag that asks for them, and its value.
    flag: &'static str,
    value: i64,
    /// Their numbers.
    answers: &'static [i64],
    /// The first two of them by name.
    names: &'static str,
}

/// The low bits of the flags, which choose the buttons.
const CHOICE: i64 = 0xf;

const BUTTONS: [Buttons; 6] = [
    Buttons { flag: "MB_OK", value: 0, answers: &[1], names: "IDOK (1)" },
    Buttons { flag: "MB_OKCANCEL", value: 1, answers: &[1, 2], names: "IDOK (1) or IDCANCEL (2)" },
    Buttons {
        flag: "MB_ABORTRETRYIGNORE",
        value: 2,
        answers: &[3, 4, 5],
        names: "IDABORT (3), IDRETRY (4) or IDIGNORE (5)",
    },
    Buttons {
        flag: "MB_YESNOCANCEL",
        value: 3,
        answers: &[2, 6, 7],
        names: "IDYES (6), IDNO (7) or IDCANCEL (2)",
    },
    Buttons { flag: "MB_YESNO", value: 4, answers: &[6, 7], names: "IDYES (6) or IDNO (7)" },
    Buttons { flag: "MB_RETRYCANCEL", value: 5, answers: &[2, 4], names: "IDRETRY (4) or IDCANCEL (2)" },
];

/// Reports answers that are compared with a number of no button, and those that are tested like a truth.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let askers = program.functions().filter_map(|function| {
        let asker = posted(program, function).filter(|_| returns_answer(program, function))?;
        Some((function.symbol, asker))
    });
    let mut search = Search { program, askers: askers.collect() };
    search.add_callers();
    program.functions().for_each(|function| search.function(function, sink));
}

/// A function of the program that shows a box and returns its answer.
#[derive(Clone, Copy)]
enum Asker {
    /// Always with the same buttons.
    Buttons(Buttons),
    /// With those of the argument at this index.
    Argument(usize),
}

struct Search<'p, 'a> {
    program: &'p AnalysedProgram<'a>,
    /// Functions of the program that show a box and return its answer.
    askers: BTreeMap<SymbolId, Asker>,
}

impl Search<'_, '_> {
    /// Adds the functions that return the answer of another.
    fn add_callers(&mut self) {
        loop {
            let callers = self.program.functions().filter_map(|function| {
                let mut answers = returned(function).into_iter().map(|value| self.answer(function, value));
                let buttons = answers.next()??;
                let is_one = answers.all(|other| other.is_some_and(|other| other.value == buttons.value));
                (is_one && !self.askers.contains_key(&function.symbol))
                    .then_some((function.symbol, Asker::Buttons(buttons)))
            });
            let callers: Vec<_> = callers.collect();
            if callers.is_empty() {
                return;
            }
            self.askers.extend(callers);
        }
    }

    fn function(&self, function: &Function, sink: &mut Sink) {
        if !self.shows_a_box(function) {
            return;
        }
        for expr in function.exprs.values() {
            let tested = match expr.kind {
                ExprKind::Compare(op @ (CompareOp::Equal | CompareOp::NotEqual), a, b) => {
                    let ExprKind::Int(number) = function.exprs[b].kind else { continue };
                    self.answer(function, a)
                        .filter(|buttons| !buttons.answers.contains(&number))
                        .map(|buttons| compared(buttons, expr.span, op == CompareOp::NotEqual, number))
                }
                ExprKind::Unary(UnaryOp::Not, value) => self.truth(function, value, false),
                ExprKind::And(a, b) | ExprKind::Or(a, b) => {
                    sink.report_if(self.truth(function, a, true));
                    self.truth(function, b, true)
                }
                ExprKind::Conditional(value, ..) => self.truth(function, value, true),
                _ => None,
            };
            sink.report_if(tested);
        }
        function.each_stmt(&mut |stmt| match &stmt.kind {
            StmtKind::If { condition, .. } => sink.report_if(self.truth(function, *condition, true)),
            StmtKind::Loop { condition: Some(condition), .. } => {
                sink.report_if(self.truth(function, *condition, true));
            }
            _ => {}
        });
    }

    /// Returns whether a function calls one that shows a box, or asks for one in the mailbox.
    fn shows_a_box(&self, function: &Function) -> bool {
        function.exprs.values().any(|expr| match &expr.kind {
            ExprKind::Call(call) => self.asked(function, call).is_some(),
            ExprKind::Assign(place, _) => element(self.program, function, *place) == Some(FLAGS),
            _ => false,
        })
    }

    /// An answer in place of a condition: no button has the number 0.
    fn truth(&self, function: &Function, value: ExprId, result: bool) -> Option<Diagnostic> {
        let buttons = self.answer(function, value).filter(|buttons| buttons.answers.len() > 1)?;
        let Buttons { flag, names, .. } = buttons;
        let message = format!("a box with the buttons of `{flag}` never answers 0");
        Some(
            Diagnostic::warning(Lint::BoxAnswer, function.exprs[value].span, message)
                .at(format!("so this is always {result}"))
                .help(format!("compare with {names}")),
        )
    }

    /// The buttons of the box whose answer a value is.
    fn answer(&self, function: &Function, value: ExprId) -> Option<Buttons> {
        match &function.exprs[value].kind {
            ExprKind::Call(call) => self.asked(function, call),
            ExprKind::Load(place) => match function.places[*place].kind {
                PlaceKind::Local(local, 0) => self.stored(function, local),
                _ if element(self.program, function, *place) == Some(ANSWER) => {
                    match posted(self.program, function)? {
                        Asker::Buttons(buttons) => Some(buttons),
                        Asker::Argument(_) => None,
                    }
                }
                _ => None,
            },
            ExprKind::Convert(inner) => self.answer(function, *inner),
            _ => None,
        }
    }

    /// The buttons of a call, by its flags.
    fn asked(&self, function: &Function, call: &Call) -> Option<Buttons> {
        let Callee::Symbol(callee) = call.callee else { return None };
        match self.askers.get(&callee) {
            Some(Asker::Buttons(buttons)) => return Some(*buttons),
            Some(Asker::Argument(index)) => {
                let ExprKind::Int(flags) = function.exprs[*call.arguments.get(*index)?].kind else {
                    return None;
                };
                return buttons(flags);
            }
            None => {}
        }
        let name = self.program.name(callee).to_lowercase();
        let is_box = name.contains("msgbox") || name.contains("messagebox");
        let flags =
            call.arguments.iter().rev().find_map(|argument| match function.exprs[*argument].kind {
                ExprKind::Int(number) => Some(number),
                _ => None,
            })?;
        (is_box && hands_on(self.program, callee)).then(|| buttons(flags)).flatten()
    }

    /// The buttons of the only box whose answer is stored in a variable.
    fn stored(&self, function: &Function, wanted: LocalId) -> Option<Buttons> {
        let is_it = |place: PlaceId| matches!(function.places[place].kind, PlaceKind::Local(local, _) if local == wanted);
        let mut found = None;
        for expr in function.exprs.values() {
            match &expr.kind {
                ExprKind::Update(update) if is_it(update.place) => return None,
                ExprKind::Address(place) if is_it(*place) => return None,
                ExprKind::Assign(place, value) if is_it(*place) => {
                    let ExprKind::Call(call) = &function.exprs[*value].kind else { return None };
                    let asked = self.asked(function, call)?;
                    if found.is_some_and(|found: Buttons| found.value != asked.value) {
                        return None;
                    }
                    found = Some(asked);
                }
                _ => {}
            }
        }
        found
    }
}

fn compared(buttons: Buttons, span: Span, result: bool, number: i64) -> Diagnostic {
    let Buttons { flag, names, .. } = buttons;
    Diagnostic::warning(
        Lint::BoxAnswer,
        span,
        format!("a box with the buttons of `{flag}` never answers {number}"),
    )
    .at(format!("always {result}"))
    .help(format!("it answers {names}"))
}

/// Returns whether a function returns the mailbox's answer.
fn returns_answer(program: &AnalysedProgram<'_>, function: &Function) -> bool {
    let returned = returned(function);
    let is_answer = |value: &ExprId| {
        matches!(function.exprs[*value].kind, ExprKind::Load(place)
            if element(program, function, place) == Some(ANSWER))
    };
    !returned.is_empty() && returned.iter().all(is_answer)
}

/// The values that a function returns.
fn returned(function: &Function) -> Vec<ExprId> {
    let mut values = Vec::new();
    function.each_stmt(&mut |stmt| {
        if let StmtKind::Return(Some(value)) = stmt.kind {
            values.push(value);
        }
    });
    values
}

/// Returns whether a function returns an answer as it is; one of the program may make another value of it.
fn hands_on(program: &AnalysedProgram<'_>, callee: SymbolId) -> bool {
    let Some(function) = program.functions().find(|function| function.symbol == callee) else { return true };
    returned(function)
        .into_iter()
        .all(|value| matches!(function.exprs[value].kind, ExprKind::Load(_) | ExprKind::Call(_)))
}

/// The buttons of the only box that a function asks for in the mailbox.
fn posted(program: &AnalysedProgram<'_>, function: &Function) -> Option<Asker> {
    let mut flags = function.exprs.values().filter_map(|expr| match expr.kind {
        ExprKind::Assign(place, value) if element(program, function, place) == Some(FLAGS) => Some(value),
        _ => None,
    });
    let (Some(value), None) = (flags.next(), flags.next()) else { return None };
    match function.exprs[value].kind {
        ExprKind::Int(flags) => buttons(flags).map(Asker::Buttons),
        ExprKind::Load(place) => {
            let PlaceKind::Local(local, 0) = function.places[place].kind else { return None };
            function.parameters.iter().position(|parameter| *parameter == local).map(Asker::Argument)
        }
        _ => None,
    }
}

fn buttons(flags: i64) -> Option<Buttons> {
    BUTTONS.into_iter().find(|buttons| buttons.value == flags & CHOICE)
}
