//! Calls: the conversion of arguments, and messages about them.
//!
//! A function that this unit defines is always called with the type of its definition, even where another prototype, or
//! none, is visible (`dialect.md` 2.2, 2.3). So a call in the typed tree always matches its function.

use kmotiondef::jumps::JumpFunction;

use super::Sema;
use super::conversions::AssignmentTarget;
use super::operands::Operand;
use crate::ast::{Expression, ExpressionKind};
use crate::diag::{Diagnostic, Lint};
use crate::source::Span;
use crate::ty::{FunctionType, ParameterTypes, QualifiedType, Type, TypeId, Types, convert};
use crate::typed::{Call, Callee, ExprId, ExprKind, Linkage, PlaceId, SymbolId};

/// An analysed argument.
type Argument = (Operand, Span);

impl Sema<'_> {
    /// `f(a, b)`
    pub(super) fn call(
        &mut self,
        callee: &Expression,
        arguments: &[Expression],
        span: Span,
    ) -> Option<Operand> {
        let function = self.callee(callee);
        let values: Vec<_> =
            arguments.iter().map(|argument| Some((self.operand(argument)?, argument.span))).collect();
        let values: Option<Vec<Argument>> = values.into_iter().collect();
        let (function, values) = (function?, values?);
        match function {
            (Callee::Symbol(symbol), visible) => self.call_symbol(symbol, visible, values, span),
            (Callee::Pointer(_), ty) => {
                let declared = self.types.function(ty)?.clone();
                let ty = self.open_type(&declared, &values);
                self.check_count(None, &ty, values.len(), span)?;
                self.finish_call(function.0, None, ty, values, span)
            }
        }
    }

    /// The function that is called, and its type as far as it is visible.
    fn callee(&mut self, callee: &Expression) -> Option<(Callee, TypeId)> {
        if let ExpressionKind::Identifier(name) = callee.kind
            && self.scopes.lookup(name).is_none()
        {
            return self.undeclared_function(name, callee.span);
        }
        let operand = self.operand(callee)?;
        if let Operand::Function(function, ty) = operand {
            return Some((function, ty));
        }
        let pointer = self.read(operand, callee.span)?;
        let ty = self.body.ty(pointer);
        let Some(to) = self.types.pointee(ty).filter(|to| self.types.is_function(to.ty)) else {
            let spelled = self.spell(self.operand_type(operand).ty);
            let diagnostic = Diagnostic::error(callee.span, format!("`{spelled}` cannot be called"))
                .at("neither a function nor a pointer to one");
            self.report(if self.types.is_pointer(ty) {
                diagnostic.help("an index needs square brackets: `[ ]`")
            } else {
                diagnostic
            });
            return None;
        };
        Some((self.callee_of(pointer), to.ty))
    }

    fn call_symbol(
        &mut self,
        symbol: SymbolId,
        visible: TypeId,
        values: Vec<Argument>,
        span: Span,
    ) -> Option<Operand> {
        if self.unevaluated == 0 {
            self.symbols.mark_used(symbol, span);
        }
        self.body.returns_twice |= self.unevaluated == 0 && self.is_setjmp(symbol);
        let given = values.len();
        let definition = self.symbols.facts(symbol).convention.as_ref().map(|definer| &definer.call);
        match definition {
            None => self.call_declared(symbol, visible, values, span),
            Some(definition) if accepts_count(definition, given) => {
                let definition = definition.clone();
                self.finish_call(Callee::Symbol(symbol), Some(symbol), definition, values, span)
            }
            Some(definition) => {
                let definition = definition.clone();
                self.call_unfitting(symbol, definition, visible, values, span)
            }
        }
    }

    /// Reports whether a function is the C library's `setjmp`.
    fn is_setjmp(&self, symbol: SymbolId) -> bool {
        let entry = self.symbols.get(symbol);
        entry.linkage == Linkage::External
            && JumpFunction::named(&entry.name) == Some(JumpFunction::Set)
            && self.symbols.facts(symbol).convention.is_none()
    }

    /// A call of a function that this unit does not define.
    fn call_declared(
        &mut self,
        symbol: SymbolId,
        visible: TypeId,
        values: Vec<Argument>,
        span: Span,
    ) -> Option<Operand> {
        let visible = self.types.function(visible)?.clone();
        let ty = match visible.parameters {
            ParameterTypes::Prototype { .. } => visible,
            ParameterTypes::Unspecified => match self.firmware_type(symbol) {
                Some(firmware) => firmware,
                None => self.open_type(&visible, &values),
            },
        };
        self.check_count(Some(symbol), &ty, values.len(), span)?;
        self.finish_call(Callee::Symbol(symbol), Some(symbol), ty, values, span)
    }

    /// A call that has another number of arguments than the definition.
    fn call_unfitting(
        &mut self,
        symbol: SymbolId,
        definition: FunctionType,
        visible: TypeId,
        values: Vec<Argument>,
        span: Span,
    ) -> Option<Operand> {
        let given = values.len();
        let visible = self.types.function(visible)?.clone();
        match &visible.parameters {
            // The visible prototype does not match either: the call is wrong.
            ParameterTypes::Prototype { .. } if !accepts_count(&visible, given) => {
                self.check_count(Some(symbol), &visible, given, span)?;
                None
            }
            ParameterTypes::Prototype { types, .. } => {
                let values = self.as_declared(symbol, values, types)?;
                self.call_adapted(symbol, definition, values, span)
            }
            ParameterTypes::Unspecified => {
                self.lint_count(symbol, &definition, given, span);
                self.call_adapted(symbol, definition, values, span)
            }
        }
    }

    /// Arguments converted to the prototype in sight, which the definition does not have.
    fn as_declared(
        &mut self,
        symbol: SymbolId,
        values: Vec<Argument>,
        types: &[QualifiedType],
    ) -> Option<Vec<Argument>> {
        let mut converted = Vec::with_capacity(values.len());
        for (index, (operand, span)) in values.into_iter().enumerate() {
            let operand = match types.get(index) {
                Some(ty) if !self.is_record(operand) => {
                    let value = self.read(operand, span)?;
                    Operand::Value(self.convert_as_assignment(
                        value,
                        ty.ty,
                        AssignmentTarget::Argument(index + 1, Some(symbol)),
                        span,
                    )?)
                }
                _ => operand,
            };
            converted.push((operand, span));
        }
        Some(converted)
    }

    /// A call with another number of arguments than the definition: missing ones are 0, surplus ones are evaluated and
    /// dropped.
    fn call_adapted(
        &mut self,
        symbol: SymbolId,
        definition: FunctionType,
        mut values: Vec<Argument>,
        span: Span,
    ) -> Option<Operand> {
        let wanted = prototype(&definition).0.to_vec();
        let extra = if values.len() > wanted.len() { values.split_off(wanted.len()) } else { Vec::new() };
        for ty in wanted.iter().skip(values.len()) {
            if self.types.record_of(ty.ty).is_some() {
                let message =
                    format!("`{}` needs a structure that is not passed", self.symbols.get(symbol).name);
                self.report(Diagnostic::error(span, message));
                return None;
            }
            values.push((Operand::Value(self.zero_value(ty.ty, span)), span));
        }
        let effects: Vec<_> =
            extra.into_iter().map(|(operand, span)| self.evaluate_effect(operand, span)).collect();
        let mut result = self.finish_call(Callee::Symbol(symbol), Some(symbol), definition, values, span)?;
        for effect in effects.into_iter().rev() {
            result = self.after(effect, result, span)?;
        }
        Some(result)
    }

    /// The message for a call without prototype that does not match the definition.
    fn lint_count(&mut self, symbol: SymbolId, definition: &FunctionType, given: usize, span: Span) {
        let (wanted, _) = prototype(definition);
        let name = self.symbols.get(symbol).name.clone();
        let (lint, at) = match given > wanted.len() {
            true => (Lint::ExtraArguments, "further ones are dropped"),
            false => (Lint::PrototypeMismatch, "missing ones are 0"),
        };
        let message =
            format!("`{name}` takes {}, but {given} {} given", count(wanted.len()), plural_verb(given));
        let definition = self.symbols.get(symbol).span;
        self.report(Diagnostic::warning(lint, span, message).at(at).label(definition, "defined here"));
    }

    /// A type whose parameters are all known: without a prototype, they have the types of the arguments.
    fn open_type(&mut self, declared: &FunctionType, values: &[Argument]) -> FunctionType {
        if declared.parameters != ParameterTypes::Unspecified {
            return declared.clone();
        }
        let types = values
            .iter()
            .map(|(operand, _)| {
                let ty = self.operand_type(*operand);
                let ty = self.types.decayed(ty).ty;
                QualifiedType::plain(if ty.is_void() { Types::INT } else { convert::argument_promoted(ty) })
            })
            .collect();
        FunctionType {
            result: declared.result,
            parameters: ParameterTypes::Prototype { types, is_variadic: false },
        }
    }

    /// Too few or too many arguments for a prototype are an error.
    fn check_count(
        &mut self,
        symbol: Option<SymbolId>,
        ty: &FunctionType,
        given: usize,
        span: Span,
    ) -> Option<()> {
        if accepts_count(ty, given) {
            return Some(());
        }
        let (types, is_variadic) = prototype(ty);
        let few = given < types.len();
        let name = symbol.map(|symbol| self.symbols.get(symbol).name.clone());
        let subject = name.as_ref().map_or_else(|| "the function".to_owned(), |name| format!("`{name}`"));
        let message = format!("too {} arguments for {subject}", if few { "few" } else { "many" });
        let at_least = if is_variadic { "at least " } else { "" };
        let at = format!("{given} given, {at_least}{} needed", types.len());
        let ty = self.types.intern(Type::Function(ty.clone()));
        let spelled = self.types.spell_declaration(self.names, ty, name.as_deref().unwrap_or("(*)"));
        let mut diagnostic =
            Diagnostic::error(span, message).at(at).note(format!("the prototype is `{spelled}`"));
        if let Some(symbol) = symbol {
            diagnostic = diagnostic.label(self.symbols.get(symbol).span, "declared here");
        }
        self.report(diagnostic);
        None
    }

    /// Converts the arguments and builds the call; `ty` has as many parameters as the call needs.
    fn finish_call(
        &mut self,
        callee: Callee,
        symbol: Option<SymbolId>,
        ty: FunctionType,
        values: Vec<Argument>,
        span: Span,
    ) -> Option<Operand> {
        let (types, is_variadic) = prototype(&ty);
        let named = types.len();
        let mut arguments = Vec::with_capacity(values.len() + 1);
        let mut variable = Vec::new();
        for (index, (operand, span)) in values.into_iter().enumerate() {
            match types.get(index) {
                Some(ty) => {
                    let target = AssignmentTarget::Argument(index + 1, symbol);
                    arguments.push(self.argument(operand, ty.ty, target, span));
                }
                None => variable.push(self.variable_argument(operand, symbol, span)),
            }
        }
        debug_assert!(variable.is_empty() || is_variadic, "the number of arguments was checked");
        debug_assert!(arguments.len() == named, "the number of arguments was checked");
        let arguments: Vec<_> = arguments.into_iter().collect::<Option<_>>()?;
        let variable: Vec<_> = variable.into_iter().collect::<Option<_>>()?;
        let variable = is_variadic.then_some(variable);
        if self.types.record_of(ty.result).is_some() {
            return self.call_for_record(callee, ty, arguments, variable, span);
        }
        let result = ty.result;
        let call = Call { callee, ty, arguments, variable };
        Some(Operand::Value(self.body.expr(ExprKind::Call(call), result, span)))
    }

    /// A call with a structure result: a temporary receives it, its address is the first argument.
    fn call_for_record(
        &mut self,
        callee: Callee,
        ty: FunctionType,
        mut arguments: Vec<ExprId>,
        variable: Option<Vec<ExprId>>,
        span: Span,
    ) -> Option<Operand> {
        if self.types.size_of(ty.result).is_none() {
            let message = format!("the result has the incomplete type `{}`", self.spell(ty.result));
            self.report(Diagnostic::error(span, message));
            return None;
        }
        let result = QualifiedType::plain(ty.result);
        let kept = self.add_local(String::new(), result, span);
        let place = self.local_place(kept, result, span).place;
        let pointer = self.types.pointer_to(ty.result);
        let address = self.address(place, pointer, span);
        arguments.insert(0, address);
        let call =
            self.body.expr(ExprKind::Call(Call { callee, ty, arguments, variable }), Types::VOID, span);
        Some(self.structure_result(call, place, span))
    }

    /// An argument converted to the type of its parameter; a structure is copied, and its address passed.
    fn argument(
        &mut self,
        operand: Operand,
        ty: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) -> Option<ExprId> {
        if self.types.record_of(ty).is_none() {
            let value = self.read(operand, span)?;
            return self.convert_as_assignment(value, ty, target, span);
        }
        let from = self.record_source(operand, ty, target, span)?;
        Some(self.copy_to_temporary(from, ty, span))
    }

    /// The address of a temporary copy of a structure.
    fn copy_to_temporary(&mut self, from: PlaceId, ty: TypeId, span: Span) -> ExprId {
        let copy = self.add_local(String::new(), QualifiedType::plain(ty), span);
        let to = self.local_place(copy, QualifiedType::plain(ty), span).place;
        let effect = self.body.expr(ExprKind::Copy { to, from }, Types::VOID, span);
        let pointer = self.types.pointer_to(ty);
        let address = self.address(to, pointer, span);
        self.body.comma(effect, address, span)
    }

    /// An argument of the variable part: `float` becomes `double`, small integers `int`, a structure the address
    /// of its copy, which `va_arg` follows. No firmware function takes one.
    fn variable_argument(
        &mut self,
        operand: Operand,
        function: Option<SymbolId>,
        span: Span,
    ) -> Option<ExprId> {
        if let Operand::Place(located) = operand
            && self.is_record(operand)
            && function.is_none_or(|function| self.firmware_type(function).is_none())
        {
            return Some(self.copy_to_temporary(located.place, located.ty.ty, span));
        }
        let value = self.read(operand, span)?;
        let value = self.promote(value, span);
        let ty = convert::argument_promoted(self.body.ty(value));
        Some(self.body.convert(value, ty, span))
    }
}

/// The parameters of a type that has a prototype.
fn prototype(ty: &FunctionType) -> (&[QualifiedType], bool) {
    match &ty.parameters {
        ParameterTypes::Unspecified => (&[], false),
        ParameterTypes::Prototype { types, is_variadic } => (types, *is_variadic),
    }
}

/// Reports whether a prototype takes this number of arguments.
fn accepts_count(ty: &FunctionType, given: usize) -> bool {
    let (types, is_variadic) = prototype(ty);
    given == types.len() || (is_variadic && given > types.len())
}

fn count(number: usize) -> String {
    match number {
        0 => "no arguments".to_owned(),
        1 => "1 argument".to_owned(),
        _ => format!("{number} arguments"),
    }
}

const fn plural_verb(number: usize) -> &'static str {
    if number == 1 { "is" } else { "are" }
}
