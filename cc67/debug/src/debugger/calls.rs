//! Expressions that call functions, and gdb's extensions: types, consecutive objects, the result of a function.

use compiler::debug::{
    AllowedCalls, CallRequest, CallResults, DebugValue, DisplayContext, NumberFormat, Probe,
};
use runtime::trace::Item;
use vm::engine::{CallEnd, ContextId};

use super::values::{CallContext, ShownVariable, string_literal, variable};
use super::{CodePlace, DebugError, Debugger};
use cc67_host::Target;

/// The part of a type that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TypeDetail {
    /// Its name.
    Name,
    /// The members of a structure.
    Members,
}

impl<T: Target> Debugger<T> {
    /// Uses the value of an expression that may call functions of the program and of the firmware; the board executes
    /// them while its time is stopped.
    fn with_called_value<R>(
        &mut self,
        expression: &str,
        work: impl FnOnce(&DebugValue, &DisplayContext<'_>) -> R,
    ) -> Result<R, DebugError> {
        let (probe, items) = self.probe(expression, AllowedCalls::Executed)?;
        let (mut results, mut has_called) = (CallResults::default(), false);
        let shown = loop {
            let view = self.view();
            let at = CallContext::new(self, view.as_ref(), &items);
            let value = probe.value_with(&at, &results);
            let Some(call) = results.take_next() else {
                let value = value?;
                let worked = work(&value, &probe.display_context(&at));
                break at.checked(worked);
            };
            let slot = self.call_function(expression, &call)?;
            results.record(&call, slot);
            has_called = true;
        };
        if has_called {
            self.changed_beyond_journal();
        }
        shown
    }

    /// Calls a function of the program or of the firmware; returns its result as a slot.
    fn call_function(&mut self, expression: &str, call: &CallRequest) -> Result<u64, DebugError> {
        let why = match self.session.call_function(self.context(), call.function, &call.arguments)? {
            CallEnd::Returned(slot) => return Ok(slot),
            CallEnd::Waits(at) => {
                let place = self.place(at.get());
                let place = place.map_or_else(String::new, |place| {
                    format!(" at {}:{}", super::file_name(&place.file), place.line)
                });
                format!("the function waits{place}, and the board stands meanwhile")
            }
            CallEnd::EndsThread => "the function ends its thread".to_owned(),
            CallEnd::Endless(limit) => {
                let seconds = limit.get() as f64 / kmotiondef::Cycles::PER_SECOND.get() as f64;
                format!("the function has not returned after {seconds} s of the processor")
            }
            CallEnd::Trapped(trap) => {
                let place = self.place(trap.at.get());
                let place = place.map_or_else(
                    || trap.at.to_string(),
                    |place| format!("{} at {}:{}", place.function, super::file_name(&place.file), place.line),
                );
                format!("{place}: {}", trap.kind)
            }
            CallEnd::NoFunction => "there is no such function in the program".to_owned(),
            CallEnd::Unsupported => "functions in code for the processor are not called".to_owned(),
        };
        Err(format!("`{expression}`: {why}; nothing has changed").into())
    }

    /// The value of an expression that may call functions.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate), or a function does not return.
    pub fn evaluate_with_calls(
        &mut self,
        expression: &str,
        format: Option<NumberFormat>,
    ) -> Result<ShownVariable, DebugError> {
        if let Some(literal) = string_literal(expression) {
            return Ok(literal);
        }
        self.with_called_value(expression, |value, shown| ShownVariable {
            text: shown.text_in(value, format),
            ..variable(expression, expression, value, shown)
        })
    }

    /// The numeric value of an expression that may call functions.
    ///
    /// # Errors
    /// As [`number`](Self::number), or a function does not return.
    pub fn number_with_calls(&mut self, expression: &str) -> Result<f64, DebugError> {
        let number = self.with_called_value(expression, |value, shown| shown.number(value))?;
        number.ok_or_else(|| format!("`{expression}` is not a number").into())
    }

    /// The type of an expression, or the type with a name.
    ///
    /// # Errors
    /// The text is neither an expression nor a type.
    pub(crate) fn type_of(&self, text: &str, detail: TypeDetail) -> Result<String, DebugError> {
        let spelled = |(probe, items): (Probe, Vec<Item>)| {
            let at = CallContext::new(self, None, &items);
            let (value, shown) = (probe.type_only(), probe.display_context(&at));
            match detail {
                TypeDetail::Name => shown.type_of(&value),
                TypeDetail::Members => shown.whole_type(&value),
            }
        };
        let found = self.probe(text, AllowedCalls::Executed);
        found
            .or_else(|error| self.probe(&format!("*({text} *)0"), AllowedCalls::Computed).map_err(|_| error))
            .map(spelled)
    }

    /// The C expression for `count` consecutive objects, beginning with a place in memory: gdb's `PLACE@COUNT`.
    ///
    /// # Errors
    /// There is no such place.
    pub(crate) fn extended(&mut self, place: &str, count: f64) -> Result<String, DebugError> {
        let found = self.with_called_value(place, |value, shown| {
            let declared = shown.declared(value, &format!("(*)[{}]", count as i64));
            value.address().map(|address| format!("(*({declared}){:#x})", address.get()))
        })?;
        let found = found.ok_or("Only values in memory can be extended with '@'.")?;
        if count < 1.0 {
            return Err(format!("Invalid number {count} of repetitions.").into());
        }
        Ok(found)
    }

    /// The result of a function that has just returned in a context.
    pub(crate) fn result_of(&self, place: &CodePlace, context: ContextId) -> Option<ShownVariable> {
        let slot = self.session.target().result(context)?;
        let model = self.programs.of(place.thread).ok()?;
        let at = CallContext::new(self, None, &[]);
        let (value, shown) = model.result(&place.function, slot, &at)?;
        Some(variable(&place.function, &place.function, &value, &shown))
    }
}
