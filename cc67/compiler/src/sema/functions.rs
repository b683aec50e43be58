//! Function definitions: their type in the first pass, their body in the second.
//!
//! The later of two definitions counts, also for earlier calls. A `void` function that
//! returns a value somewhere returns `int` (`dialect.md` 1.3); that is decided here, before
//! any call is checked.

use super::Sema;
use super::body::Body;
use super::declarators::{DeclaredParameter, parameter_types};
use super::scope::{ClosedScope, Entity};
use super::specifiers::ImplicitInt;
use super::symbols::CallingConvention;
use crate::ast::{Derived, FunctionDefinition, Parameters, Statement, StatementKind, Storage};
use crate::diag::{Diagnostic, Lint};
use crate::lints::unused_label;
use crate::names::{Name, word};
use crate::source::Span;
use crate::ty::{FunctionType, ParameterTypes, QualifiedType, Type, TypeId, Types, convert};
use crate::typed::{Definition, Function, LocalId, Stmt, StmtKind, SymbolId};

/// A definition whose body waits for the second pass.
#[derive(Debug)]
pub(super) struct PendingDefinition<'t> {
    item: usize,
    definition: &'t FunctionDefinition,
    symbol: SymbolId,
    name: Name,
    span: Span,
    parameters: Vec<DeclaredParameter>,
    closed: ClosedScope,
}

impl Sema<'_> {
    /// Enters the name and type of a definition.
    pub(super) fn declare_definition<'t>(
        &mut self,
        definition: &'t FunctionDefinition,
        item: usize,
    ) -> Option<PendingDefinition<'t>> {
        let (name, span) = definition.declarator.name?;
        let Some(signature) = self.signature(definition, span) else {
            self.scopes.bind(name, Entity::Poisoned, span);
            return None;
        };
        let Signature { declared, call, parameters, closed, is_void_with_value } = signature;
        let storage = definition.specifiers.storage.map(|(storage, _)| storage);
        let storage = self.check_main(name, span, storage, &parameters);
        let declared_type = self.types.intern(Type::Function(declared.clone()));
        let symbol = self.function_symbol(name, declared_type, storage, span)?;
        self.lint_defined_twice(symbol, span);
        let visible = self.types.intern(Type::Function(FunctionType { result: call.result, ..declared }));
        self.scopes.bind(name, Entity::Function(symbol, visible), span);
        let ty = self.types.intern(Type::Function(call.clone()));
        self.symbols.facts_mut(symbol).convention =
            Some(CallingConvention { call, declared: declared_type, span, is_void_with_value });
        let entry = self.symbols.get_mut(symbol);
        entry.ty = ty;
        entry.definition = Definition::Function;
        entry.span = span;
        Some(PendingDefinition { item, definition, symbol, name, span, parameters, closed })
    }

    fn signature(&mut self, definition: &FunctionDefinition, span: Span) -> Option<Signature> {
        let base = self.specified_type(&definition.specifiers, ImplicitInt::Silent)?;
        let Some((Derived::Function(list), outer)) = definition.declarator.derived.split_first() else {
            self.report(Diagnostic::error(span, "a function definition needs a parameter list"));
            return None;
        };
        let result = self.derived_type(base, outer, span)?;
        self.scopes.enter();
        let parameters = self.parameters(list);
        let parameters = parameters.and_then(|parameters| self.old_style(definition, list, parameters));
        let closed = self.scopes.leave();
        let parameters = parameters?;
        self.check_result(result, span)?;
        let ty = self.function_of(result, parameter_types(list, &parameters), span)?;
        let declared = self.types.function(ty.ty)?.clone();
        let is_void_with_value = result.ty.is_void() && returns_value(&definition.body);
        let call = FunctionType {
            result: if is_void_with_value { Types::INT } else { result.ty },
            parameters: passed_types(list, &parameters),
        };
        Some(Signature { declared, call, parameters, closed, is_void_with_value })
    }

    fn check_result(&mut self, result: QualifiedType, span: Span) -> Option<()> {
        if self.types.record_of(result.ty).is_some() && self.types.size_of(result.ty).is_none() {
            let spelled = self.spell(result.ty);
            self.report(Diagnostic::error(span, format!("the result has the incomplete type `{spelled}`")));
            return None;
        }
        Some(())
    }

    /// Takes the types of old-style parameters from the declarations after the list.
    fn old_style(
        &mut self,
        definition: &FunctionDefinition,
        list: &Parameters,
        mut parameters: Vec<DeclaredParameter>,
    ) -> Option<Vec<DeclaredParameter>> {
        let Parameters::Names(names) = list else { return Some(parameters) };
        if let Some((_, span)) = names.first() {
            self.report(
                Diagnostic::warning(Lint::OldStyleDefinition, *span, "old-style parameter list")
                    .help("write the types inside the parentheses"),
            );
        }
        for declaration in &definition.old_style {
            let base = self.specified_type(&declaration.specifiers, ImplicitInt::Warn)?;
            for init in &declaration.declarators {
                let declared = self.declared_name(Some(base), &declaration.specifiers, init)?;
                let ty = self.types.decayed(declared.ty);
                match parameters.iter_mut().find(|parameter| parameter.name == Some(declared.name)) {
                    Some(parameter) => parameter.ty = ty,
                    None => {
                        let message =
                            format!("`{}` is not in the parameter list", self.spelling(declared.name));
                        self.report(Diagnostic::error(declared.span, message));
                        return None;
                    }
                }
            }
        }
        Some(parameters)
    }

    /// Checks `main`, which is visible to the linker whatever its declaration, and gets no arguments.
    fn check_main(
        &mut self,
        name: Name,
        span: Span,
        storage: Option<Storage>,
        parameters: &[DeclaredParameter],
    ) -> Option<Storage> {
        if name != word::MAIN {
            return storage;
        }
        if let Some(parameter) = parameters.first() {
            self.report(
                Diagnostic::warning(
                    Lint::MainParameters,
                    parameter.span,
                    "`main` is called without arguments",
                )
                .at("always 0")
                .help("write `main()`"),
            );
        }
        if storage == Some(Storage::Static) {
            self.report(
                Diagnostic::warning(Lint::Extension, span, "`main` is declared `static`")
                    .note("the vendor's linker then does not find it")
                    .help("remove `static`"),
            );
            return None;
        }
        storage
    }

    fn lint_defined_twice(&mut self, symbol: SymbolId, span: Span) {
        let Some(first) = self.symbols.facts(symbol).convention.as_ref().map(|definer| definer.span) else {
            return;
        };
        let message = format!("function `{}` is defined twice", self.symbols.get(symbol).name);
        self.report(
            Diagnostic::warning(Lint::Redeclared, span, message)
                .at("this definition counts, also for the calls before it")
                .label(first, "this one is ignored"),
        );
    }

    /// The second pass: the body. `None` for a definition that a later one replaces.
    pub(super) fn define_function(&mut self, pending: PendingDefinition<'_>) -> Option<Function> {
        let PendingDefinition { item, definition, symbol, name, span, parameters, closed } = pending;
        let definer =
            self.symbols.facts(symbol).convention.as_ref().filter(|definer| definer.span == span)?;
        let (ty, is_void) =
            (definer.call.clone(), definer.is_void_with_value || definer.call.result.is_void());
        let errors = self.sink.errors();
        self.scopes.at_item(item);
        self.scopes.reopen(closed);
        self.body = Body::new(self.names.get(name).to_owned(), ty.result);
        self.body.is_void = is_void;
        let mut statements = Vec::new();
        let incoming = self.hidden_parameters(&ty, &parameters, span, &mut statements);
        self.scopes.enter();
        if let StatementKind::Block(inner) = &definition.body.kind {
            self.statements(inner, &mut statements);
        }
        self.scopes.leave();
        self.scopes.leave();
        self.check_labels();
        if self.body.returns_twice {
            self.body.keep_in_memory(span);
        }
        let body = std::mem::replace(&mut self.body, Body::new(String::new(), Types::VOID));
        let end = Span { lo: definition.span.hi.saturating_sub(1), ..definition.span };
        Some(Function {
            symbol,
            ty,
            parameters: incoming,
            hidden: body.hidden,
            locals: body.locals,
            exprs: body.exprs,
            places: body.places,
            labels: body.jumps.labels,
            body: statements,
            span,
            end,
            has_errors: self.sink.errors() > errors,
        })
    }

    /// Makes the locals that arguments arrive in and binds the names of the parameters.
    fn hidden_parameters(
        &mut self,
        ty: &FunctionType,
        parameters: &[DeclaredParameter],
        span: Span,
        out: &mut Vec<Stmt>,
    ) -> Vec<LocalId> {
        if self.types.record_of(ty.result).is_some() {
            let pointer = self.types.pointer_to(ty.result);
            self.body.hidden.result_pointer = Some(self.body.temporary(pointer, false, span));
        }
        let ParameterTypes::Prototype { types, is_variadic } = &ty.parameters else { return Vec::new() };
        let incoming = parameters
            .iter()
            .zip(types)
            .map(|(parameter, ty)| self.incoming(*parameter, ty.ty, out))
            .collect();
        if *is_variadic {
            let pointer = self.types.pointer_to(Types::CHAR);
            self.body.hidden.variable_arguments = Some(self.body.temporary(pointer, false, span));
        }
        incoming
    }

    /// Declares a parameter. An old-style `float` arrives as a `double` and is converted at the entry.
    fn incoming(&mut self, parameter: DeclaredParameter, passed: TypeId, out: &mut Vec<Stmt>) -> LocalId {
        let DeclaredParameter { name, ty, span } = parameter;
        let spelling = name.map_or_else(String::new, |name| self.names.get(name).to_owned());
        let local = self.add_local(spelling, ty, span);
        self.body.locals[local].by_pointer = self.types.record_of(ty.ty).is_some();
        if let Some(name) = name {
            if self
                .scopes
                .lookup_here(name)
                .is_some_and(|binding| matches!(binding.entity, Entity::Local(..)))
            {
                let message = format!("two parameters are called `{}`", self.spelling(name));
                self.report(Diagnostic::error(span, message));
            }
            self.scopes.bind(name, Entity::Local(local, ty), span);
        }
        if passed == ty.ty {
            return local;
        }
        let arrived = self.body.temporary(passed, false, span);
        let value = self.body.load_local(arrived, span);
        let value = self.body.convert(value, ty.ty, span);
        let store = self.body.store_local(local, value, span);
        out.push(Stmt { kind: StmtKind::Expr(store), span });
        arrived
    }

    /// Every `goto` needs its label.
    fn check_labels(&mut self) {
        let missing: Vec<_> = self
            .body
            .jumps
            .label_names
            .iter()
            .filter_map(|(name, state)| Some((*name, state.used.filter(|_| state.defined.is_none())?)))
            .collect();
        for (name, span) in missing {
            let message = format!("label `{}` is used but not defined", self.spelling(name));
            self.report(Diagnostic::error(span, message));
        }
        // Code with errors may have contained the `goto`.
        if self.sink.has_errors() {
            return;
        }
        let unused: Vec<_> = self
            .body
            .jumps
            .label_names
            .iter()
            .filter_map(|(name, state)| Some((*name, state.defined.filter(|_| state.used.is_none())?)))
            .collect();
        for (name, span) in unused {
            self.report(unused_label::finding(self.spelling(name), span));
        }
    }
}

/// The signature of a definition, from its head.
struct Signature {
    /// The type as written.
    declared: FunctionType,
    /// The type as called.
    call: FunctionType,
    parameters: Vec<DeclaredParameter>,
    closed: ClosedScope,
    is_void_with_value: bool,
}

/// The types in which arguments are passed to a definition.
fn passed_types(list: &Parameters, parameters: &[DeclaredParameter]) -> ParameterTypes {
    let promote = matches!(list, Parameters::Names(_));
    let types = parameters
        .iter()
        .map(|parameter| match promote {
            true => convert::argument_promoted(parameter.ty.ty),
            false => parameter.ty.ty,
        })
        .map(QualifiedType::plain)
        .collect();
    let is_variadic = matches!(list, Parameters::Prototype { is_variadic: true, .. });
    ParameterTypes::Prototype { types, is_variadic }
}

/// Reports whether a statement contains `return` with a value.
fn returns_value(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Return(value) => value.is_some(),
        StatementKind::Block(inner) => inner.iter().any(returns_value),
        StatementKind::If { then, otherwise, .. } => {
            returns_value(then) || otherwise.as_deref().is_some_and(returns_value)
        }
        StatementKind::While { body, .. }
        | StatementKind::DoWhile { body, .. }
        | StatementKind::For { body, .. }
        | StatementKind::Switch { body, .. }
        | StatementKind::Case { body, .. }
        | StatementKind::Default(body)
        | StatementKind::Label { body, .. } => returns_value(body),
        _ => false,
    }
}
