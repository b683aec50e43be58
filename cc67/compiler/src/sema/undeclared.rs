//! Names without a visible declaration.
//!
//! A call finds the unit's own later definition, then the firmware's prototype (`dialect.md` 2.3). Everything else is
//! an error that suggests the nearest name.

use kmotiondef::CType;
use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::{Function, Origin};

use super::Sema;
use super::advice::{Advice, HEADER_HELP, is_axis};
use super::scope::Entity;
use crate::diag::{Diagnostic, Lint};
use crate::names::Name;
use crate::source::Span;
use crate::ty::{FunctionType, ParameterTypes, QualifiedType, Type, TypeId, Types};
use crate::typed::{Callee, Linkage, SymbolId};
use crate::words::suggest;

impl Sema<'_> {
    /// A call of a name without declaration.
    pub(super) fn undeclared_function(&mut self, name: Name, span: Span) -> Option<(Callee, TypeId)> {
        match self.symbols.linked_symbol(name) {
            Some(symbol) if self.types.is_function(self.symbols.get(symbol).ty) => {
                self.late_function(symbol, span);
                Some((Callee::Symbol(symbol), self.symbols.get(symbol).ty))
            }
            Some(_) => {
                self.undeclared(name, span);
                None
            }
            None => self.implicit_firmware(name, span),
        }
    }

    /// A function that is declared or defined later.
    fn late_function(&mut self, symbol: SymbolId, span: Span) {
        if std::mem::replace(&mut self.symbols.facts_mut(symbol).is_reported, true) {
            return;
        }
        let entry = self.symbols.get(symbol);
        let (name, place, ty) = (entry.name.clone(), entry.span, entry.ty);
        let is_defined = self.symbols.facts(symbol).convention.is_some();
        let prototype = self.types.spell_declaration(self.names, ty, &name);
        let (lint, at) = match (is_defined, self.is_plain(ty)) {
            (true, true) => (Lint::LateDefinition, "the definition further down is used"),
            (true, false) => {
                (Lint::ImplicitDeclaration, "the definition further down is used; the board would not")
            }
            (false, _) => (Lint::ImplicitDeclaration, "the declaration further down is used"),
        };
        self.report(
            Diagnostic::warning(lint, span, format!("`{name}` is called before it is declared"))
                .at(at)
                .label(place, "here")
                .help(format!("write `{prototype};` at the top")),
        );
    }

    /// Reports whether a call without prototype also works on the board: only integers and pointers.
    fn is_plain(&self, ty: TypeId) -> bool {
        let is_word = |ty: TypeId| self.types.is_pointer(ty) || (ty.is_integer() && !ty.is_long_long());
        self.types.function(ty).is_some_and(|function| {
            (function.result.is_void() || is_word(function.result))
                && match &function.parameters {
                    ParameterTypes::Unspecified => true,
                    ParameterTypes::Prototype { types, is_variadic } => {
                        !is_variadic && types.iter().all(|ty| is_word(ty.ty))
                    }
                }
        })
    }

    /// A function that is only known from the firmware.
    fn implicit_firmware(&mut self, name: Name, span: Span) -> Option<(Callee, TypeId)> {
        let later = self.scopes.lookup_later(name).map(|binding| binding.entity);
        if later == Some(Entity::Poisoned) {
            return None;
        }
        let spelling = self.names.get(name);
        let Some(function) = self.firmware_function(spelling) else {
            self.undefined_function(name, span);
            return None;
        };
        let ty = self.types.intern(Type::Function(function));
        let prototype = self.types.spell_declaration(self.names, ty, spelling);
        let symbol = self.symbols.declare(name, spelling, Linkage::External, ty, span);
        self.symbols.facts_mut(symbol).is_reported = true;
        // A header that was not found may declare it.
        if !self.sink.lacks_names() {
            let is_library = self.firmware.origin(spelling) == Some(Origin::Library);
            let message = format!("`{spelling}` is not declared");
            let finding = Diagnostic::warning(Lint::ImplicitDeclaration, span, message);
            self.report(match (is_library, self.firmware.origin(spelling) == Some(Origin::Header)) {
                (true, _) => finding
                    .at(format!("the firmware has no such function; cc67 adds its own `{prototype}`"))
                    .note("the vendor's compiler reports an undefined symbol")
                    .help(match stand_in(spelling) {
                        Some(other) => format!("`{other}` is in the firmware"),
                        None if spelling == Function::abs.name() => format!(
                            "declare it, `{prototype};`, for an `int`; for a `double` write `{}`",
                            Function::fast_fabs.name()
                        ),
                        None => format!("declare it, `{prototype};`, or define a function of your own"),
                    }),
                (false, true) => finding
                    .at(format!("the firmware's `{prototype}` is used"))
                    .help("include `KMotionDef.h`, or declare the function"),
                (false, false) => finding
                    .at(format!("the firmware's `{prototype}` is used"))
                    .help(format!("`KMotionDef.h` lacks it; declare it: `{prototype};`")),
            });
        }
        Some((Callee::Symbol(symbol), ty))
    }

    /// The firmware's type of a function that this unit does not define.
    pub(super) fn firmware_type(&mut self, symbol: SymbolId) -> Option<FunctionType> {
        let entry = self.symbols.get(symbol);
        if entry.linkage == Linkage::Internal {
            return None;
        }
        let name = entry.name.clone();
        self.firmware_function(&name)
    }

    fn firmware_function(&mut self, name: &str) -> Option<FunctionType> {
        let prototype = self.firmware.prototype(name)?;
        let result = self.interface_type(&prototype.result).ty;
        let types = prototype.parameters.iter().map(|ty| {
            let ty = self.interface_type(ty);
            QualifiedType::plain(self.types.decayed(ty).ty)
        });
        let types = types.collect();
        let parameters = ParameterTypes::Prototype { types, is_variadic: prototype.is_variadic };
        Some(FunctionType { result, parameters })
    }

    /// A type of the board's interface. One that the program does not define is a pointer to `void`.
    fn interface_type(&mut self, ty: &CType) -> QualifiedType {
        QualifiedType::plain(match *ty {
            CType::Void => Types::VOID,
            CType::Char => Types::CHAR,
            CType::SignedChar => Types::SIGNED_CHAR,
            CType::UnsignedChar => Types::UNSIGNED_CHAR,
            CType::Short => Types::SHORT,
            CType::UnsignedShort => Types::UNSIGNED_SHORT,
            CType::Int | CType::Long => Types::INT,
            CType::UnsignedInt | CType::UnsignedLong => Types::UNSIGNED,
            CType::Float => Types::FLOAT,
            CType::Double => Types::DOUBLE,
            CType::Named(name) => return self.interface_name(name),
            CType::Const(inner) => return QualifiedType { is_const: true, ..self.interface_type(inner) },
            CType::Volatile(inner) => {
                return QualifiedType { is_volatile: true, ..self.interface_type(inner) };
            }
            CType::Pointer(to) => {
                let to = self.interface_type(to);
                self.types.pointer_to_qualified(to)
            }
            CType::Array(element, length) => {
                let element = self.interface_type(element);
                self.types.intern(Type::Array(element, Some(length)))
            }
            CType::Function { result, params } => {
                let result = self.interface_type(result).ty;
                let types = params.iter().map(|ty| self.interface_type(ty)).collect();
                let parameters = ParameterTypes::Prototype { types, is_variadic: false };
                self.types.intern(Type::Function(FunctionType { result, parameters }))
            }
        })
    }

    fn interface_name(&mut self, name: &'static str) -> QualifiedType {
        let entity =
            self.names.find(name).and_then(|name| self.scopes.lookup(name)).map(|binding| binding.entity);
        match entity {
            Some(Entity::Typedef(ty)) => ty,
            _ => match CType::Named(name).resolved() {
                CType::Named(_) => QualifiedType::plain(Types::VOID),
                known => self.interface_type(&known),
            },
        }
    }

    fn undefined_function(&mut self, name: Name, span: Span) {
        if !self.body.undeclared.insert(name) {
            return;
        }
        let Advice::Say(advice) = self.advice(name) else { return };
        let spelling = self.names.get(name);
        if let Some(diagnostic) = of_other_board(self.firmware.board(), spelling, span) {
            self.report(diagnostic.undefined(spelling));
            return;
        }
        let diagnostic = Diagnostic::error(span, format!("undefined function `{spelling}`"))
            .at("neither this program nor the firmware has it")
            .undefined(spelling);
        self.report(advice(diagnostic));
    }

    /// A variable without declaration; reported once per function.
    pub(super) fn undeclared(&mut self, name: Name, span: Span) {
        if !self.body.undeclared.insert(name) {
            return;
        }
        let diagnostic = Diagnostic::error(span, format!("`{}` is not declared", self.spelling(name)));
        let later = self.scopes.lookup_later(name).map(|binding| (binding.entity, binding.span));
        if let Some((entity, place)) = later {
            if entity != Entity::Poisoned {
                let diagnostic = diagnostic.label(place, "declared here, after its use");
                self.report(diagnostic.help("move the declaration up"));
            }
            return;
        }
        if let Advice::Say(advice) = self.advice(name) {
            let other = of_other_board(self.firmware.board(), self.names.get(name), span);
            self.report(other.unwrap_or_else(|| advice(diagnostic)));
        }
    }

    /// A type name that no typedef defines.
    pub(super) fn unknown_type(&mut self, name: Name, span: Span) {
        if self.sink.lacks_names() {
            return;
        }
        let spelling = self.names.get(name);
        let mut diagnostic = Diagnostic::error(span, format!("unknown type `{spelling}`"));
        if self.firmware.is_type(spelling) {
            diagnostic = diagnostic.help(HEADER_HELP);
        } else if let Some(near) = self.near_type(spelling) {
            diagnostic = diagnostic.help(format!("did you mean `{near}`?"));
        }
        self.report(diagnostic);
    }

    /// The nearest visible name.
    pub(super) fn near_name(&self, spelling: &str) -> Option<&str> {
        let own = self.scopes.visible().filter(|binding| !matches!(binding.entity, Entity::Typedef(_)));
        let own = own.map(|binding| self.names.get(binding.name));
        suggest(spelling, own.chain(self.firmware.names()).filter(|name| is_sensible(spelling, name)))
    }

    fn near_type(&self, spelling: &str) -> Option<&str> {
        let own = self.scopes.visible().filter(|binding| matches!(binding.entity, Entity::Typedef(_)));
        suggest(spelling, own.map(|binding| self.names.get(binding.name)))
    }
}

/// The message for a name that the firmware of another board has.
fn of_other_board(board: &TargetBoard, name: &str, span: Span) -> Option<Diagnostic> {
    let other = board.other_with(name).filter(|_| !is_axis(name))?;
    let message = format!("`{name}` is of {}; this program is built for {}", other.title(), board.title());
    Some(Diagnostic::error(span, message).help(format!("`--board {}` builds for that firmware", other.name)))
}

/// Reports whether a name may be suggested for another: every single letter is close to every other, so only its case
/// may differ.
pub(super) fn is_sensible(spelling: &str, name: &str) -> bool {
    spelling.len() > 1 || name.eq_ignore_ascii_case(spelling)
}

/// A function of the firmware that does the same as one that it lacks.
fn stand_in(name: &str) -> Option<&'static str> {
    let same = [(Function::fabs, Function::fast_fabs), (Function::fabsf, Function::fast_fabsf)];
    same.into_iter().find(|(lacking, _)| lacking.name() == name).map(|(_, other)| other.name())
}
