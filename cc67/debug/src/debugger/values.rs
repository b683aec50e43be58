//! Values: expressions in the context of a call, locals, and assignments to them.

use std::cell::{Cell, RefCell};

use compiler::debug::{
    AllowedCalls, Child, DebugReader, DebugValue, DisplayContext, LocalModel, LocalPlace, Location,
    NumberFormat, Probe,
};
use kmotiondef::{Axes, GuestAddr};
use runtime::trace::Item;
use vm::engine::{ContextId, FrameView};

use super::breakpoints::{Subject, WatchedExpression};
use super::{DebugError, Debugger, StackFrame};
use crate::programs::{Activation, Programs};
use cc67_host::session::with_user_data;
use cc67_host::{Session, Target};

/// A variable for show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownVariable {
    /// Its name.
    pub name: String,
    /// Its type as C spells it.
    pub ty: String,
    /// Its value in one line.
    pub text: String,
    /// The C expression for it.
    pub expression: String,
    /// The number of its parts.
    pub parts: u32,
    /// Its address in memory.
    pub address: Option<u32>,
    /// The words before a pointer that is shown by itself, such as `(int *) `.
    pub cast: String,
    /// The C expression of the value as it is now, if there is one.
    pub literal: Option<String>,
}

/// A board and a call, as expressions read them.
pub(crate) struct CallContext<'a, T> {
    session: &'a Session<T>,
    programs: &'a Programs,
    view: Option<&'a FrameView>,
    items: &'a [Item],
    /// The addresses that were read so far, if they are of interest.
    reads: Option<RefCell<Vec<GuestAddr>>>,
    /// True if registers were.
    has_registers: Cell<bool>,
    /// The first error of a target that does not answer.
    failed: RefCell<Option<DebugError>>,
}

impl<'a, T> CallContext<'a, T> {
    pub(super) fn new(debugger: &'a Debugger<T>, view: Option<&'a FrameView>, items: &'a [Item]) -> Self
    where
        T: Target,
    {
        let Debugger { session, programs, .. } = debugger;
        let (has_registers, failed) = (Cell::new(false), RefCell::new(None));
        Self { session, programs, view, items, reads: None, has_registers, failed }
    }

    /// Returns a value that was read, unless the target did not answer.
    pub(super) fn checked<R>(&self, value: R) -> Result<R, DebugError> {
        self.failed.borrow_mut().take().map_or(Ok(value), Err)
    }
}

/// An expression that was compiled once, for the place where it was set.
#[derive(Debug)]
pub(super) struct PreparedExpression {
    probe: Probe,
    items: Vec<Item>,
    /// The call that it is of: its context, and how many calls of the machine there were with it.
    pub(super) frame: Option<(ContextId, usize)>,
}

impl<T: Target> DebugReader for CallContext<'_, T> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        if let Some(reads) = &self.reads {
            reads.borrow_mut().push(address);
        }
        let mut bytes = [0; 8];
        if let Err(error) = self.session.target().read(address, &mut bytes) {
            self.failed.borrow_mut().get_or_insert_with(|| error.into());
        }
        bytes
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).map_or(0.0, |item| self.session.target().value(*item))
    }

    fn is_mapped(&self, address: GuestAddr) -> bool {
        self.session.target().is_mapped(address)
    }

    fn symbol(&self, address: GuestAddr) -> Option<String> {
        self.programs.all().find_map(|(_, model)| model.symbol_at(address.get()))
    }

    fn local(&self, local: &LocalModel) -> Option<LocalPlace> {
        let view = self.view?;
        let register = |number: u16| view.registers.get(usize::from(number)).copied();
        Some(match local.location_at(view.at.get())? {
            Location::Register(number) => {
                self.has_registers.set(true);
                LocalPlace::Slot(register(number)?)
            }
            Location::Frame(offset) => LocalPlace::Memory(view.frame.offset(offset)),
            Location::Pointer(number) => LocalPlace::Memory(GuestAddr::new(register(number)? as u32)),
            Location::Constant(bits) => LocalPlace::Slot(bits),
        })
    }
}

/// A board, as expressions without locals read it every tick.
struct TickContext<'a, T> {
    target: &'a T,
    items: &'a [Item],
}

impl<T: Target> DebugReader for TickContext<'_, T> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        // A value that is unknown counts as 0.
        self.word(address).unwrap_or_default()
    }

    fn word(&self, address: GuestAddr) -> Option<[u8; 8]> {
        self.target.word(address)
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).map_or(0.0, |item| self.target.value(*item))
    }

    fn is_mapped(&self, address: GuestAddr) -> bool {
        self.target.is_mapped(address)
    }

    fn local(&self, _: &LocalModel) -> Option<LocalPlace> {
        None
    }
}

/// The names in an expression that are items of the board and not the program's.
fn items_in(axes: Axes, expression: &str) -> Vec<(&str, Item)> {
    let words = expression.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let mut items: Vec<_> = words.filter_map(|word| Some((word, Item::among(axes, word).ok()?))).collect();
    items.sort_unstable_by_key(|(word, _)| *word);
    items.dedup_by_key(|(word, _)| *word);
    items
}

/// Compiles an expression for an instruction, in one of the functions that it is in, or outside functions for a
/// thread's program.
fn compile(
    programs: &Programs,
    thread: kmotiondef::ThreadId,
    at: Option<(u32, usize)>,
    expression: &str,
    calls: AllowedCalls,
) -> Result<(Probe, Vec<Item>), DebugError> {
    let (thread, expression) = match expression.split_once(':') {
        Some((number, rest)) if number.trim().parse().ok().and_then(kmotiondef::ThreadId::new).is_some() => {
            (number.trim().parse().ok().and_then(kmotiondef::ThreadId::new).unwrap_or(thread), rest)
        }
        _ => (thread, expression),
    };
    let expression = with_user_data(expression);
    let found = at.and_then(|(address, level)| programs.activations(address).into_iter().nth(level));
    let place = found.filter(|found| found.thread == thread).map(|found| found.scope);
    let any = || programs.all().next().map(|(_, model)| model);
    let model = match programs.of(thread) {
        Ok(model) => model,
        Err(why) => any().ok_or(why)?,
    };
    match model.probe(place, &expression, &[], calls) {
        Ok(probe) => Ok((probe, Vec::new())),
        Err(error) => {
            let (names, items): (Vec<_>, Vec<_>) = items_in(programs.axes(), &expression).into_iter().unzip();
            if names.is_empty() {
                return Err(in_words_of_gdb(&expression, &error).into());
            }
            let probe = model
                .probe(place, &expression, &names, calls)
                .map_err(|error| in_words_of_gdb(&expression, &error))?;
            Ok((probe, items))
        }
    }
}

/// The message on an expression that does not compile, where gdb has one of its own.
fn in_words_of_gdb(expression: &str, error: &str) -> String {
    let between = |text: &str, before: &str| {
        text.split_once(before).and_then(|(_, rest)| rest.split_once('`')).map(|(name, _)| name.to_owned())
    };
    let hint = between(error, "did you mean `").map(|name| format!("  Did you mean `{name}`?"));
    let hint = hint.unwrap_or_default();
    if error.starts_with('`')
        && let Some(name) =
            between(error, "`").filter(|name| error.starts_with(&format!("`{name}` is not declared")))
    {
        return format!("No symbol \"{name}\" in current context.{hint}");
    }
    match between(error, "has no member `") {
        Some(name) => format!("There is no member named {name}.{hint}"),
        None => format!("`{expression}`: {error}"),
    }
}

impl<T: Target> Debugger<T> {
    /// The selected call.
    fn call(&self) -> Option<StackFrame> {
        self.frames(self.context()).into_iter().nth(self.frame)
    }

    pub(super) fn view(&self) -> Option<FrameView> {
        self.call().map(|frame| frame.view)
    }

    pub(super) fn probe(
        &self,
        expression: &str,
        calls: AllowedCalls,
    ) -> Result<(Probe, Vec<Item>), DebugError> {
        let at = self.call().map(|frame| (frame.address.get(), frame.level));
        compile(&self.programs, self.thread, at, expression, calls)
    }

    /// An expression, compiled for the selected call.
    pub(super) fn prepare(&self, expression: &str) -> Result<PreparedExpression, DebugError> {
        let (probe, items) = self.probe(expression, AllowedCalls::Computed)?;
        let depth = |call: StackFrame| self.session.frames(self.context()).len() - call.real;
        let call = self.call().filter(|_| probe.has_locals());
        Ok(PreparedExpression { probe, items, frame: call.map(|call| (self.context(), depth(call))) })
    }

    /// An expression, compiled for an instruction.
    pub(super) fn prepare_at(
        &self,
        address: u32,
        expression: &str,
    ) -> Result<PreparedExpression, DebugError> {
        let thread = self.programs.at(address).map_or(self.thread, |(thread, ..)| thread);
        let (probe, items) =
            compile(&self.programs, thread, Some((address, 0)), expression, AllowedCalls::Computed)?;
        Ok(PreparedExpression { probe, items, frame: None })
    }

    /// The call that an expression was compiled for, if it is still in progress.
    fn view_of(&self, prepared: &PreparedExpression) -> Option<FrameView> {
        let (context, depth) = prepared.frame?;
        let mut views = self.session.frames(context);
        let index = views.len().checked_sub(depth)?;
        (index < views.len()).then(|| views.swap_remove(index))
    }

    /// Returns whether an expression is not 0 in a call.
    fn is_true(&self, prepared: &PreparedExpression, view: Option<&FrameView>) -> Result<bool, DebugError> {
        let at = CallContext::new(self, view, &prepared.items);
        let value = prepared.probe.value(&at)?;
        Ok(prepared.probe.display_context(&at).number(&value).is_some_and(|number| number != 0.0))
    }

    /// Returns whether the expression of a breakpoint is so at present; not where it has no value.
    pub(super) fn is_so(&self, breakpoint: &super::Breakpoint) -> bool {
        let Subject::Truth(prepared, _) = &breakpoint.subject else { return false };
        if prepared.probe.has_locals() {
            let view = self.view_of(prepared);
            return prepared.probe.is_true(&CallContext::new(self, view.as_ref(), &prepared.items));
        }
        prepared.probe.is_true(&TickContext { target: self.session.target(), items: &prepared.items })
    }

    fn with_value<R>(
        &self,
        expression: &str,
        work: impl FnOnce(&Probe, &DebugValue, &DisplayContext<'_>) -> R,
    ) -> Result<R, DebugError> {
        let (probe, items) = self.probe(expression, AllowedCalls::Computed)?;
        let view = self.view();
        let at = CallContext::new(self, view.as_ref(), &items);
        let value = probe.value(&at)?;
        let worked = work(&probe, &value, &probe.display_context(&at));
        at.checked(worked)
    }

    /// The value of an expression where the call that is looked at stands.
    ///
    /// # Errors
    /// The expression is wrong, or a local is optimised out.
    pub fn evaluate(&self, expression: &str) -> Result<ShownVariable, DebugError> {
        self.look_at(expression, None)
    }

    /// The value of an expression, its numbers in a format.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    pub fn look_at(
        &self,
        expression: &str,
        format: Option<NumberFormat>,
    ) -> Result<ShownVariable, DebugError> {
        if let Some(literal) = string_literal(expression) {
            return Ok(literal);
        }
        self.with_value(expression, |_, value, shown| ShownVariable {
            text: shown.text_in(value, format),
            ..variable(expression, expression, value, shown)
        })
    }

    /// The number that an expression is.
    ///
    /// # Errors
    /// What is wrong with it, or that it is no number.
    pub fn number(&self, expression: &str) -> Result<f64, DebugError> {
        let number = self.with_value(expression, |_, value, shown| shown.number(value))?;
        number.ok_or_else(|| format!("`{expression}` is not a number").into())
    }

    /// The parts of a structure, an array, or what a pointer points at.
    ///
    /// # Errors
    /// The expression is wrong.
    pub fn parts(&self, expression: &str, first: u32, count: u32) -> Result<Vec<ShownVariable>, DebugError> {
        self.with_value(expression, |_, value, shown| {
            let children = shown.children(value, expression, first, count);
            children
                .iter()
                .map(|Child { name, expression, value }| variable(name, expression, value, shown))
                .collect()
        })
    }

    /// The locals that are visible in the selected call.
    #[must_use]
    pub fn locals(&self) -> Vec<ShownVariable> {
        let Some(call) = self.call() else { return Vec::new() };
        let activations = self.programs.activations(call.address.get());
        let Some(Activation { model, scope, .. }) = activations.get(call.level) else { return Vec::new() };
        let at = CallContext::new(self, Some(&call.view), &[]);
        let visible = |local: &&LocalModel| local.lines.contains(&scope.line);
        let mut shown: Vec<ShownVariable> = Vec::new();
        for local in scope.locals.iter().filter(visible) {
            // A name that is declared again hides the one before.
            shown.retain(|known| known.name != local.name);
            shown.push(match model.local(local, &at) {
                Some((value, types)) => variable(&local.name, &local.name, &value, &types),
                None => ShownVariable {
                    name: local.name.clone(),
                    ty: local.ty.clone(),
                    text: "<optimized out>".to_owned(),
                    expression: local.name.clone(),
                    parts: 0,
                    address: None,
                    cast: String::new(),
                    literal: None,
                },
            });
        }
        shown
    }

    /// Those of them that are not arguments, those of inner blocks first.
    pub(crate) fn own_locals(&self) -> Vec<ShownVariable> {
        let mut shown = self.locals();
        let call = self.call();
        let activations = call.as_ref().map(|call| self.programs.activations(call.address.get()));
        let found = activations.as_ref().zip(call.as_ref()).and_then(|(all, call)| all.get(call.level));
        let Some(Activation { model, scope, .. }) = found else { return shown };
        let arguments = scope.locals.get(..model.parameters(scope.function)).unwrap_or_default();
        shown.retain(|one| !arguments.iter().any(|argument| argument.name == one.name));
        // The block of the last declaration of a name that is visible ends where the name does.
        shown.sort_by_key(|one| {
            let declared = scope.locals.iter().rev().filter(|local| local.name == one.name);
            declared.filter(|local| local.lines.contains(&scope.line)).map(|local| local.lines.end).next()
        });
        shown
    }

    /// The arguments of a call, `NAME=VALUE` each, as it has them now.
    #[must_use]
    pub fn arguments(&self, call: &StackFrame) -> Vec<String> {
        let activations = self.programs.activations(call.address.get());
        let Some(Activation { model, scope, .. }) = activations.get(call.level) else { return Vec::new() };
        let at = CallContext::new(self, Some(&call.view), &[]);
        let text = |local: &LocalModel| {
            let value = model.local(local, &at).map(|(value, types)| types.text(&value));
            format!("{}={}", local.name, value.as_deref().unwrap_or("<optimized out>"))
        };
        scope.locals.iter().take(model.parameters(scope.function)).map(text).collect()
    }

    /// The variables of the program outside functions.
    #[must_use]
    pub fn globals(&self) -> Vec<ShownVariable> {
        let Ok(model) = self.programs.of(self.thread) else { return Vec::new() };
        let at = CallContext::new(self, None, &[]);
        let all = model.globals();
        let shown = all.iter().filter_map(|(name, _, address)| {
            let (value, types) = model.global(name, *address, &at)?;
            Some(variable(name, name, &value, &types))
        });
        shown.collect()
    }

    /// Gives a variable another value, as an assignment in C would.
    ///
    /// # Errors
    /// An expression is wrong, or the first is not a place.
    pub fn set(&mut self, expression: &str, value: &str) -> Result<ShownVariable, DebugError> {
        let number = self.number_with_calls(value)?;
        let (probe, items) = self.probe(expression, AllowedCalls::Computed)?;
        let view = self.view();
        let (bytes, address, register) = {
            let at = CallContext::new(self, view.as_ref(), &items);
            let place = probe.value(&at)?;
            let bytes = probe.bytes_of(&place, number, &at);
            let bytes = bytes.ok_or_else(|| format!("`{expression}` takes no number"))?;
            let register = match (probe.as_local(), &view) {
                (Some(local), Some(view)) => match local.location_at(view.at.get()) {
                    Some(Location::Register(number)) => Some(number),
                    _ => None,
                },
                _ => None,
            };
            (bytes, place.address(), register)
        };
        if let Some(register) = register {
            let mut slot = [0; 8];
            let is_signed_small = bytes.len() < 4 && bytes.last().is_some_and(|byte| byte & 0x80 != 0);
            slot[..bytes.len()].copy_from_slice(&bytes);
            if is_signed_small {
                slot[bytes.len()..4].fill(0xff);
            }
            let context = self.context();
            let real = self.call().map_or(0, |call| call.real);
            self.session.set_register(context, real, register, u64::from_le_bytes(slot));
        } else {
            let address = address
                .ok_or_else(|| format!("`{expression}` is not a variable, so nothing can be stored in it"))?;
            self.session.store(address, &bytes).map_err(|error| error.to_string())?;
        }
        self.changed();
        self.evaluate(expression)
    }

    /// Stores bytes in memory.
    ///
    /// # Errors
    /// There is no memory.
    pub fn store(&mut self, address: u32, bytes: &[u8]) -> Result<(), DebugError> {
        self.session.store(GuestAddr::new(address), bytes).map_err(|error| error.to_string())?;
        self.changed();
        Ok(())
    }

    /// Bytes of memory; 0 outside it.
    #[must_use]
    pub fn bytes(&self, address: u32, count: u32) -> Vec<u8> {
        let mut bytes = vec![0; count as usize];
        // What a target does not answer reads 0.
        let _ = self.session.target().read(GuestAddr::new(address), &mut bytes);
        bytes
    }

    /// Returns whether a condition holds: at an instruction in the innermost call of a context, otherwise where it was set.
    pub(super) fn holds(
        &self,
        context: ContextId,
        conditions: &[(u32, PreparedExpression)],
    ) -> Result<bool, DebugError> {
        if let [(0, prepared)] = conditions {
            return self.is_true(prepared, self.view_of(prepared).as_ref());
        }
        let views = self.session.frames(context);
        let view = views.first().ok_or("its thread has ended")?;
        let here = conditions.iter().find(|(address, _)| *address == view.at.get());
        let (_, prepared) = here.ok_or("it does not compile for the program that is loaded now")?;
        self.is_true(prepared, Some(view))
    }

    /// The text of a log point with the values of what is in braces.
    pub(crate) fn filled(&self, text: &str) -> String {
        let mut out = String::new();
        let mut rest = text;
        while let Some((before, more)) = rest.split_once('{') {
            out.push_str(before);
            let Some((expression, behind)) = more.split_once('}') else {
                out.push('{');
                rest = more;
                continue;
            };
            match self.evaluate(expression) {
                Ok(value) => out.push_str(&value.text),
                Err(error) => out.push_str(&format!("<{error}>")),
            }
            rest = behind;
        }
        out + rest
    }

    /// A watched expression with its present value.
    pub(super) fn watched(&self, expression: &str) -> Result<WatchedExpression, DebugError> {
        let prepared = self.prepare(expression)?;
        let view = self.view();
        let mut at = CallContext::new(self, view.as_ref(), &prepared.items);
        at.reads = Some(RefCell::default());
        let value = prepared.probe.value(&at)?;
        let shown = prepared.probe.display_context(&at);
        let last = shown.text(&value);
        let own = value.address().map(|address| (address, shown.size_of(&value)));
        let ranges = ranges(own, at.reads.as_ref().map(RefCell::take).unwrap_or_default());
        let (has_registers, is_polled) = (at.has_registers.get(), !prepared.items.is_empty());
        if ranges.is_empty() && !has_registers && !is_polled {
            return Err(format!("Cannot watch constant value `{expression}'.").into());
        }
        Ok(WatchedExpression { prepared, ranges, own, has_registers, is_polled, last })
    }

    /// The present value of what a breakpoint watches; `None` if the call that it is of has ended, or it is nowhere.
    pub(super) fn watched_text(&self, watched: &WatchedExpression) -> Option<String> {
        let WatchedExpression { prepared, .. } = watched;
        let view = self.view_of(prepared);
        let at = CallContext::new(self, view.as_ref(), &prepared.items);
        let value = prepared.probe.value(&at).ok()?;
        Some(prepared.probe.display_context(&at).text(&value))
    }

    /// Updates the values of watched expressions after any kind of change.
    pub(super) fn refresh_watches(&mut self) {
        for index in 0..self.breakpoints.len() {
            let text =
                self.breakpoints[index].subject.expression().and_then(|watched| self.watched_text(watched));
            if let (Some(watched), Some(text)) = (self.breakpoints[index].subject.expression_mut(), text) {
                watched.last = text;
            }
            let is_so = self.is_so(&self.breakpoints[index]);
            if let Some(was_so) = self.breakpoints[index].subject.was_true_mut() {
                *was_so = is_so;
            }
        }
    }
}

/// The memory that a value is in, and what else was read for it: pointers, indexes, operands.
fn ranges(own: Option<(GuestAddr, u32)>, mut reads: Vec<GuestAddr>) -> Vec<(GuestAddr, u32)> {
    let is_own = |at: &GuestAddr| own.is_some_and(|(from, size)| at.get().wrapping_sub(from.get()) < size);
    reads.retain(|at| !is_own(at));
    reads.sort_unstable();
    reads.dedup();
    let mut ranges: Vec<(GuestAddr, u32)> = own.into_iter().collect();
    for at in reads {
        // Which of the eight bytes were needed is not known; a change of the others alone changes no value.
        match ranges.last_mut().filter(|_| own.is_none()) {
            Some((from, size)) if at.get().wrapping_sub(from.get()) <= *size => {
                *size = at.get().wrapping_sub(from.get()) + 8;
            }
            _ => ranges.push((at, 8)),
        }
    }
    ranges
}

/// A string literal as a value.
pub(super) fn string_literal(expression: &str) -> Option<ShownVariable> {
    let text = expression.trim();
    let inside = text.strip_prefix('"')?.strip_suffix('"')?;
    let mut is_escaped = false;
    let is_whole = inside.chars().all(|letter| {
        let is_end = letter == '"' && !is_escaped;
        is_escaped = letter == '\\' && !is_escaped;
        !is_end
    });
    let shown = |ty| ShownVariable {
        name: text.to_owned(),
        ty,
        text: text.to_owned(),
        expression: text.to_owned(),
        parts: 0,
        address: None,
        cast: String::new(),
        literal: Some(text.to_owned()),
    };
    (is_whole && !is_escaped).then(|| shown("char []".to_owned()))
}

pub(super) fn variable(
    name: &str,
    expression: &str,
    value: &DebugValue,
    shown: &DisplayContext<'_>,
) -> ShownVariable {
    ShownVariable {
        name: name.to_owned(),
        ty: shown.type_of(value),
        text: shown.text(value),
        expression: expression.to_owned(),
        parts: shown.count(value),
        address: value.address().map(GuestAddr::get),
        cast: shown.cast(value),
        literal: shown.literal(value),
    }
}
