//! Declarations: typedefs, objects and functions with linkage, at file scope and in blocks.

use super::Sema;
use super::scope::Entity;
use super::specifiers::ImplicitInt;
use crate::ast::{Declaration, InitDeclarator, Initializer, Specifiers, StaticAssert, Storage};
use crate::diag::{Diagnostic, Lint};
use crate::names::Name;
use crate::source::Span;
use crate::ty::layout::MAX_OBJECT_SIZE;
use crate::ty::{QualifiedType, Type, TypeId, Types};
use crate::typed::{Definition, Linkage, SymbolId};

/// A declared name with its type, before it is bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeclaredName<'t> {
    /// The name.
    pub(super) name: Name,
    /// Its range in the source.
    pub(super) span: Span,
    /// The type.
    pub(super) ty: QualifiedType,
    /// The requested alignment, otherwise 1.
    pub(super) align: u32,
    /// The initialiser.
    pub(super) initializer: Option<&'t Initializer>,
}

impl Sema<'_> {
    /// A declaration at file scope.
    pub(super) fn file_declaration(&mut self, declaration: &Declaration) {
        let storage = declaration.specifiers.storage.map(|(storage, _)| storage);
        self.check_file_storage(declaration);
        let base = self.specified_type(&declaration.specifiers, ImplicitInt::Warn);
        for init in &declaration.declarators {
            let Some(declared) = self.declared_name(base, &declaration.specifiers, init) else { continue };
            match storage {
                Some(Storage::Typedef) => self.declare_typedef(declared, declaration),
                _ if self.types.is_function(declared.ty.ty) => self.declare_function(declared, storage),
                _ => self.declare_object(declared, storage),
            }
        }
    }

    fn check_file_storage(&mut self, declaration: &Declaration) {
        if let Some((Storage::Auto | Storage::Register, span)) = declaration.specifiers.storage {
            self.report(
                Diagnostic::warning(
                    Lint::Extension,
                    span,
                    "`auto` and `register` mean nothing at file scope",
                )
                .help("remove the word"),
            );
        }
    }

    /// A declared name with its type; a name with a wrong type is bound as poisoned.
    pub(super) fn declared_name<'t>(
        &mut self,
        base: Option<QualifiedType>,
        specifiers: &Specifiers,
        init: &'t InitDeclarator,
    ) -> Option<DeclaredName<'t>> {
        let (name, span) = init.declarator.name?;
        let ty = base.and_then(|base| self.derived_type(base, &init.declarator.derived, span));
        let Some(ty) = ty else {
            self.scopes.bind(name, Entity::Poisoned, span);
            return None;
        };
        let align = self.alignment(&specifiers.alignments).max(self.alignment(&init.declarator.alignments));
        Some(DeclaredName { name, span, ty, align, initializer: init.initializer.as_ref() })
    }

    /// A typedef; the same again is accepted.
    pub(super) fn declare_typedef(&mut self, declared: DeclaredName<'_>, declaration: &Declaration) {
        let DeclaredName { name, span, ty, initializer, .. } = declared;
        if let Some(Initializer::Expression(_) | Initializer::List { .. }) = initializer {
            self.report(Diagnostic::error(span, "a typedef cannot have an initialiser"));
        }
        match self.scopes.lookup_here(name).map(|binding| (binding.entity, binding.span)) {
            Some((Entity::Typedef(known), first)) if known != ty => {
                let (new, old) = (self.spell(ty.ty), self.spell(known.ty));
                let message = format!("typedef `{}` is redefined as a different type", self.spelling(name));
                self.report(
                    Diagnostic::error(span, message)
                        .at(format!("`{new}` here"))
                        .label(first, format!("`{old}` here")),
                );
                return;
            }
            Some((Entity::Typedef(_) | Entity::Poisoned, _)) | None => {}
            Some((_, first)) => return self.already_declared(name, span, first),
        }
        if ty.ty == Types::INT {
            self.note_enum_typedef(declaration.specifiers.ty.as_ref(), span);
        }
        if let Some(record) = self.types.record_of(ty.ty) {
            self.types.record_mut(record).name.get_or_insert(name);
        }
        self.scopes.bind(name, Entity::Typedef(ty), span);
    }

    fn already_declared(&mut self, name: Name, span: Span, first: Span) {
        let message = format!("`{}` is already declared as something else", self.spelling(name));
        self.report(Diagnostic::error(span, message).label(first, "declared here"));
    }

    /// A function prototype, at file scope or in a block.
    pub(super) fn declare_function(&mut self, declared: DeclaredName<'_>, storage: Option<Storage>) {
        let DeclaredName { name, span, ty, initializer, .. } = declared;
        if initializer.is_some() {
            self.report(Diagnostic::error(span, "a function cannot have an initialiser"));
        }
        if let Some(symbol) = self.function_symbol(name, ty.ty, storage, span) {
            self.scopes.bind(name, Entity::Function(symbol, ty.ty), span);
        }
    }

    /// The symbol of a function that is declared or defined with type `ty`; the last type counts.
    pub(super) fn function_symbol(
        &mut self,
        name: Name,
        ty: TypeId,
        storage: Option<Storage>,
        span: Span,
    ) -> Option<SymbolId> {
        if let Some(first) = self.other_kind_here(name, |entity| matches!(entity, Entity::Function(..))) {
            self.already_declared(name, span, first);
            return None;
        }
        let Some(symbol) = self.symbols.linked_symbol(name) else {
            let linkage =
                if storage == Some(Storage::Static) { Linkage::Internal } else { Linkage::External };
            let spelling = self.names.get(name);
            return Some(self.symbols.declare(name, spelling, linkage, ty, span));
        };
        let known = self.symbols.get(symbol);
        let (known_type, first) = (known.ty, known.span);
        if !self.types.is_function(known_type) {
            self.already_declared(name, span, first);
            return None;
        }
        let declared =
            self.symbols.facts(symbol).convention.as_ref().map_or(known_type, |definer| definer.declared);
        if !self.types.compatible(declared, ty) {
            self.lint_prototype(name, declared, first, ty, span);
        }
        let composite = self.types.composite(known_type, ty);
        let is_defined = self.symbols.facts(symbol).convention.is_some();
        let entry = self.symbols.get_mut(symbol);
        if storage == Some(Storage::Static) {
            entry.linkage = Linkage::Internal;
        }
        if !is_defined {
            entry.ty = composite;
        }
        Some(symbol)
    }

    fn lint_prototype(&mut self, name: Name, old: TypeId, first: Span, new: TypeId, span: Span) {
        let spelling = self.spelling(name);
        let (old, new) = (
            self.types.spell_declaration(self.names, old, spelling),
            self.types.spell_declaration(self.names, new, spelling),
        );
        let message = format!("`{spelling}` is declared in two different ways");
        self.report(
            Diagnostic::warning(Lint::PrototypeMismatch, span, message)
                .at(format!("`{new}` here"))
                .label(first, format!("`{old}` here"))
                .note("calls use the definition"),
        );
    }

    /// The declaration of a name in the innermost scope, if it is not of the expected kind.
    fn other_kind_here(&self, name: Name, is_expected: impl Fn(Entity) -> bool) -> Option<Span> {
        let binding = self.scopes.lookup_here(name)?;
        (!is_expected(binding.entity) && binding.entity != Entity::Poisoned).then_some(binding.span)
    }

    /// A variable with linkage: at file scope, or `extern` in a block.
    pub(super) fn declare_object(&mut self, declared: DeclaredName<'_>, storage: Option<Storage>) {
        let DeclaredName { name, span, ty, align, initializer } = declared;
        let Some(symbol) = self.object_symbol(name, ty.ty, storage, span) else {
            self.scopes.bind(name, Entity::Poisoned, span);
            return;
        };
        let entry = self.symbols.get_mut(symbol);
        entry.align = entry.align.max(align);
        let ty = QualifiedType { ty: entry.ty, ..ty };
        self.scopes.bind(name, Entity::Object(symbol, ty), span);
        match initializer {
            Some(initializer) => {
                if let Some((complete, data)) = self.static_initializer(ty, initializer, span) {
                    self.define_data(symbol, complete, data, span);
                    self.scopes.rebind(name, Entity::Object(symbol, QualifiedType { ty: complete, ..ty }));
                }
            }
            None if storage != Some(Storage::Extern) => {
                let entry = self.symbols.get_mut(symbol);
                if matches!(entry.definition, Definition::None) {
                    entry.definition = Definition::Tentative;
                    entry.span = span;
                }
            }
            None => {}
        }
    }

    /// Two initialised definitions must agree (`dialect.md` 2.2).
    fn define_data(&mut self, symbol: SymbolId, ty: TypeId, data: crate::typed::StaticData, span: Span) {
        let entry = self.symbols.get_mut(symbol);
        if let Definition::Data(known) = &entry.definition
            && *known != data
        {
            let (message, first) =
                (format!("`{}` is defined twice with different values", entry.name), entry.span);
            self.report(Diagnostic::error(span, message).label(first, "first definition"));
            return;
        }
        entry.ty = ty;
        entry.definition = Definition::Data(data);
        entry.span = span;
    }

    fn object_symbol(
        &mut self,
        name: Name,
        ty: TypeId,
        storage: Option<Storage>,
        span: Span,
    ) -> Option<SymbolId> {
        if let Some(first) = self.other_kind_here(name, |entity| matches!(entity, Entity::Object(..))) {
            self.already_declared(name, span, first);
            return None;
        }
        if ty.is_void() {
            let message = format!("variable `{}` cannot have type `void`", self.spelling(name));
            self.report(Diagnostic::error(span, message));
            return None;
        }
        self.check_size(name, ty, span)?;
        let Some(symbol) = self.symbols.linked_symbol(name) else {
            let linkage =
                if storage == Some(Storage::Static) { Linkage::Internal } else { Linkage::External };
            let spelling = self.names.get(name);
            return Some(self.symbols.declare(name, spelling, linkage, ty, span));
        };
        let known = self.symbols.get(symbol);
        let (known_type, first) = (known.ty, known.span);
        if !self.types.compatible(known_type, ty) {
            let (old, new) = (self.spell(known_type), self.spell(ty));
            if let Some(kept) = self.longer_array(symbol, known_type, ty) {
                let message = format!("`{}` is declared with two different sizes", self.spelling(name));
                self.report(
                    Diagnostic::warning(Lint::Redeclared, span, message)
                        .at(format!("`{new}` here"))
                        .label(first, format!("`{old}` here"))
                        .note("cc67 takes the larger one, the vendor's compiler the first one")
                        .help("write the size once, or give the arrays different names"),
                );
                self.symbols.get_mut(symbol).ty = kept;
                return Some(symbol);
            }
            let message = format!("`{}` is redeclared with a different type", self.spelling(name));
            self.report(
                Diagnostic::error(span, message)
                    .at(format!("`{new}` here"))
                    .label(first, format!("`{old}` here")),
            );
            return None;
        }
        let composite = self.types.composite(known_type, ty);
        let entry = self.symbols.get_mut(symbol);
        entry.ty = composite;
        if storage == Some(Storage::Static) {
            entry.linkage = Linkage::Internal;
        }
        Some(symbol)
    }

    /// The longer of two arrays that differ only in their length, if neither has a value yet: the vendor's compiler
    /// accepts both.
    fn longer_array(&self, symbol: SymbolId, known: TypeId, new: TypeId) -> Option<TypeId> {
        let (a, length) = self.types.array(known)?;
        let (b, new_length) = self.types.array(new)?;
        let is_open = !matches!(self.symbols.get(symbol).definition, Definition::Data(_));
        let is_longer = new_length > length;
        (is_open && self.types.compatible(a.ty, b.ty)).then_some(if is_longer { new } else { known })
    }

    /// `_Static_assert`
    pub(super) fn static_assert(&mut self, assertion: &StaticAssert) {
        let Some(0) = self.constant_integer(&assertion.condition, "the condition of a static assertion")
        else {
            return;
        };
        let message = match &assertion.message {
            Some(text) => format!("static assertion failed: {}", String::from_utf8_lossy(text)),
            None => "static assertion failed".to_owned(),
        };
        self.report(Diagnostic::error(assertion.condition.span, message).at("this is 0"));
    }

    /// Refuses a variable that no memory of the board holds.
    fn check_size(&mut self, name: Name, ty: TypeId, span: Span) -> Option<()> {
        let size = self.types.size_of(ty).filter(|size| *size > MAX_OBJECT_SIZE);
        if let Some(size) = size {
            let message = format!("`{}` is too large: {size} bytes", self.spelling(name));
            self.report(
                Diagnostic::error(span, message).note(format!("the limit is {MAX_OBJECT_SIZE} bytes")),
            );
        }
        size.is_none().then_some(())
    }

    /// Rejects a variable of unknown size.
    pub(super) fn check_complete(&mut self, name: Name, ty: TypeId, span: Span) -> Option<()> {
        if self.types.is_object(ty) {
            return self.check_size(name, ty, span);
        }
        let (name, spelled) = (self.spelling(name), self.spell(ty));
        let diagnostic = Diagnostic::error(span, format!("`{name}` has the incomplete type `{spelled}`"));
        let is_array = matches!(self.types.get(ty), Type::Array(_, None));
        self.report(if is_array { diagnostic.help("give the number of elements") } else { diagnostic });
        None
    }
}
