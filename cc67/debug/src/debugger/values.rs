//! Values: expressions where a call stands, locals, and other values for them.

use compiler::debug::{Child, DebugReader, DebugValue, Displayed, LocalModel, LocalPlace, Location, Probe};
use kmotiondef::GuestAddr;
use vm::engine::{ContextId, FrameView};

use super::{DebugError, Debugger, StackFrame, WatchedExpression};
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
    /// How C names it.
    pub expression: String,
    /// How many parts it has.
    pub parts: u32,
    /// Where it is in memory.
    pub address: Option<u32>,
}

/// A board and a call, as expressions read them.
pub(crate) struct At<'a, T> {
    session: &'a Session<T>,
    view: Option<&'a FrameView>,
    items: Vec<String>,
}

impl<T: Target> DebugReader for At<'_, T> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        std::array::from_fn(|offset| self.session.peek(address.offset(offset as u32)))
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).and_then(|item| self.session.item(item)).unwrap_or(0.0)
    }

    fn local(&self, local: &LocalModel) -> Option<LocalPlace> {
        let view = self.view?;
        let register = |number: u16| view.registers.get(usize::from(number)).copied();
        Some(match local.at(view.at.get())? {
            Location::Register(number) => LocalPlace::Slot(register(number)?),
            Location::Frame(offset) => LocalPlace::Memory(view.frame.offset(offset)),
            Location::Pointer(number) => LocalPlace::Memory(GuestAddr::new(register(number)? as u32)),
            Location::Constant(bits) => LocalPlace::Slot(bits),
        })
    }
}

/// The names in an expression that are items of the board and not the program's.
fn items_in<T: Target>(expression: &str, session: &Session<T>) -> Vec<String> {
    let words = expression.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let mut items: Vec<_> = words.filter(|word| session.item(word).is_some()).map(str::to_owned).collect();
    items.sort();
    items.dedup();
    items
}

/// Compiles an expression for an instruction, in one of the functions that it is in, or outside of functions for a
/// thread's program.
fn compile<T: Target>(
    programs: &Programs,
    session: &Session<T>,
    thread: kmotiondef::ThreadId,
    at: Option<(u32, usize)>,
    expression: &str,
) -> Result<(Probe, Vec<String>), DebugError> {
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
    match model.probe(place, &expression, &[]) {
        Ok(probe) => Ok((probe, Vec::new())),
        Err(error) => {
            let items = items_in(&expression, session);
            if items.is_empty() {
                return Err(format!("`{expression}`: {error}").into());
            }
            let names: Vec<_> = items.iter().map(String::as_str).collect();
            let probe = model
                .probe(place, &expression, &names)
                .map_err(|error| format!("`{expression}`: {error}"))?;
            Ok((probe, items))
        }
    }
}

impl<T: Target> Debugger<T> {
    /// The call that is looked at.
    fn call(&self) -> Option<StackFrame> {
        self.frames(self.context()).into_iter().nth(self.frame)
    }

    fn view(&self) -> Option<FrameView> {
        self.call().map(|frame| frame.view)
    }

    pub(crate) fn probe(&self, expression: &str) -> Result<(Probe, Vec<String>), DebugError> {
        let at = self.call().map(|frame| (frame.address.get(), frame.level));
        compile(&self.programs, &self.session, self.thread, at, expression)
    }

    pub(crate) fn probe_at(
        &self,
        address: u32,
        expression: &str,
    ) -> Result<(Probe, Vec<String>), DebugError> {
        let thread = self.programs.at(address).map_or(self.thread, |(thread, ..)| thread);
        compile(&self.programs, &self.session, thread, Some((address, 0)), expression)
    }

    fn with_value<R>(
        &self,
        expression: &str,
        work: impl FnOnce(&Probe, &DebugValue, &Displayed<'_>) -> R,
    ) -> Result<R, DebugError> {
        let (probe, items) = self.probe(expression)?;
        let view = self.view();
        let at = At { session: &self.session, view: view.as_ref(), items };
        let value = probe.value(&at)?;
        Ok(work(&probe, &value, &probe.shown(&at)))
    }

    /// The value of an expression where the call that is looked at stands.
    ///
    /// # Errors
    /// What is wrong with the expression, or that a local is optimised out.
    pub fn evaluate(&self, expression: &str) -> Result<ShownVariable, DebugError> {
        self.with_value(expression, |_, value, shown| variable(expression, expression, value, shown))
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
    /// What is wrong with the expression.
    pub fn parts(&self, expression: &str, first: u32, count: u32) -> Result<Vec<ShownVariable>, DebugError> {
        self.with_value(expression, |_, value, shown| {
            let children = shown.children(value, expression, first, count);
            children
                .iter()
                .map(|Child { name, expression, value }| variable(name, expression, value, shown))
                .collect()
        })
    }

    /// The locals that are visible where the call that is looked at stands.
    #[must_use]
    pub fn locals(&self) -> Vec<ShownVariable> {
        let Some(call) = self.call() else { return Vec::new() };
        let activations = self.programs.activations(call.address.get());
        let Some(Activation { model, scope, .. }) = activations.get(call.level) else { return Vec::new() };
        let at = At { session: &self.session, view: Some(&call.view), items: Vec::new() };
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
                    text: "<optimised out>".to_owned(),
                    expression: local.name.clone(),
                    parts: 0,
                    address: None,
                },
            });
        }
        shown
    }

    /// The variables of the program outside of functions.
    #[must_use]
    pub fn globals(&self) -> Vec<ShownVariable> {
        let Ok(model) = self.programs.of(self.thread) else { return Vec::new() };
        let at = At { session: &self.session, view: None, items: Vec::new() };
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
    /// What is wrong with the expressions, or that the first is not a place.
    pub fn set(&mut self, expression: &str, value: &str) -> Result<ShownVariable, DebugError> {
        let number = self.number(value)?;
        let (probe, items) = self.probe(expression)?;
        let view = self.view();
        let (bytes, address, register) = {
            let at = At { session: &self.session, view: view.as_ref(), items };
            let place = probe.value(&at)?;
            let bytes = probe.bytes_of(&place, number, &at);
            let bytes = bytes.ok_or_else(|| format!("`{expression}` takes no number"))?;
            let register = match (probe.as_local(), &view) {
                (Some(local), Some(view)) => match local.at(view.at.get()) {
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

    /// Bytes of memory; 0 outside of it.
    #[must_use]
    pub fn bytes(&self, address: u32, count: u32) -> Vec<u8> {
        let mut bytes = vec![0; count as usize];
        // What a target does not answer reads 0.
        let _ = self.session.target().read(GuestAddr::new(address), &mut bytes);
        bytes
    }

    /// Whether a condition holds in the innermost call of a context.
    pub(crate) fn holds(&self, context: ContextId, condition: &str) -> Result<bool, DebugError> {
        let views = self.session.frames(context);
        let view = views.first();
        let address = view.map_or(0, |view| view.at.get());
        let (probe, items) = self.probe_at(address, condition)?;
        let at = At { session: &self.session, view, items };
        let value = probe.value(&at)?;
        Ok(probe.shown(&at).number(&value).is_some_and(|number| number != 0.0))
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
        let (probe, items) = self.probe(expression)?;
        let view = self.view();
        let at = At { session: &self.session, view: view.as_ref(), items };
        let value = probe.value(&at)?;
        let shown = probe.shown(&at);
        let last = shown.text(&value);
        let ranges: Vec<_> =
            value.address().map(|address| (address, shown.size_of(&value))).into_iter().collect();
        let real = self.call().map_or(0, |call| call.real);
        let frame =
            view.is_some().then(|| (self.context(), self.session.frames(self.context()).len() - real));
        if ranges.is_empty() && probe.as_local().is_none() {
            return Err(format!("`{expression}` is not a variable; watch one of those in it").into());
        }
        Ok(WatchedExpression { probe, frame, ranges, last })
    }

    /// The present value of what a breakpoint watches; `None` if the call that it is of has ended, or it is nowhere.
    pub(super) fn watched_text(&self, watched: &WatchedExpression) -> Option<String> {
        let views = watched.frame.map(|(context, _)| self.session.frames(context)).unwrap_or_default();
        let view = match watched.frame {
            Some((_, depth)) => views.len().checked_sub(depth).and_then(|index| views.get(index)),
            None => None,
        };
        let at = At { session: &self.session, view, items: Vec::new() };
        let value = watched.probe.value(&at).ok()?;
        Some(watched.probe.shown(&at).text(&value))
    }

    /// What is watched has its present values, however it came to them.
    pub(super) fn refresh_watches(&mut self) {
        for index in 0..self.breakpoints.len() {
            let text =
                self.breakpoints[index].watched.as_ref().and_then(|watched| self.watched_text(watched));
            if let (Some(watched), Some(text)) = (&mut self.breakpoints[index].watched, text) {
                watched.last = text;
            }
        }
    }
}

fn variable(name: &str, expression: &str, value: &DebugValue, shown: &Displayed<'_>) -> ShownVariable {
    ShownVariable {
        name: name.to_owned(),
        ty: shown.type_of(value),
        text: shown.text(value),
        expression: expression.to_owned(),
        parts: shown.count(value),
        address: value.address().map(GuestAddr::get),
    }
}
