//! Declarations in blocks.

use super::Sema;
use super::declarations::DeclaredName;
use super::scope::Entity;
use super::specifiers::ImplicitInt;
use crate::ast::{Declaration, Storage};
use crate::diag::{Diagnostic, Lint};
use crate::names::Name;
use crate::source::Span;
use crate::ty::{QualifiedType, TypeId};
use crate::typed::{Definition, Local, LocalId, Stmt, StmtKind};

impl Sema<'_> {
    /// A declaration among statements; initialisers become stores.
    pub(super) fn block_declaration(&mut self, declaration: &Declaration, out: &mut Vec<Stmt>) {
        let storage = declaration.specifiers.storage.map(|(storage, _)| storage);
        // One at a time: an initialiser sees the names before it.
        let base = self.specified_type(&declaration.specifiers, ImplicitInt::Silent);
        for init in &declaration.declarators {
            let Some(declared) = self.declared_name(base, &declaration.specifiers, init) else { continue };
            match storage {
                Some(Storage::Typedef) => self.declare_typedef(declared, declaration),
                _ if self.types.is_function(declared.ty.ty) => self.declare_function(declared, storage),
                Some(Storage::Extern) => self.declare_object(declared, storage),
                Some(Storage::Static) => self.declare_static(declared),
                None | Some(Storage::Auto | Storage::Register) => self.declare_local(declared, out),
            }
        }
    }

    /// A static variable of a function, which gets its own symbol.
    fn declare_static(&mut self, declared: DeclaredName<'_>) {
        let DeclaredName { name, span, ty, align, initializer } = declared;
        self.lint_declared_twice(name, span);
        let symbol = self.symbols.internal(self.names.get(name), ty.ty, span);
        self.symbols.get_mut(symbol).align = align;
        self.scopes.bind(name, Entity::Object(symbol, ty), span);
        let complete = match initializer {
            None => ty.ty,
            Some(initializer) => match self.static_initializer(ty, initializer, span) {
                Some((complete, data)) => {
                    self.symbols.get_mut(symbol).definition = Definition::Data(data);
                    complete
                }
                None => return,
            },
        };
        let entity = match self.check_complete(name, complete, span) {
            Some(()) => Entity::Object(symbol, QualifiedType { ty: complete, ..ty }),
            None => Entity::Poisoned,
        };
        self.symbols.get_mut(symbol).ty = complete;
        self.scopes.rebind(name, entity);
    }

    fn declare_local(&mut self, declared: DeclaredName<'_>, out: &mut Vec<Stmt>) {
        let DeclaredName { name, span, ty, align, initializer } = declared;
        self.lint_declared_twice(name, span);
        let is_open_array = initializer.is_some() && self.types.array(ty.ty).is_some();
        if !is_open_array && self.check_complete(name, ty.ty, span).is_none() {
            self.scopes.bind(name, Entity::Poisoned, span);
            return;
        }
        let local = self.add_local(self.names.get(name).to_owned(), ty, span);
        self.body.locals[local].align = align;
        self.noted.locals_elsewhere.entry(name).or_insert_with(|| (self.body.name.clone(), span));
        self.scopes.bind(name, Entity::Local(local, ty), span);
        let Some(initializer) = initializer else { return };
        let Some((complete, effects)) = self.local_initializer(local, ty, initializer, span) else {
            if self.types.size_of(ty.ty).is_none() {
                self.scopes.rebind(name, Entity::Poisoned);
            }
            return;
        };
        self.scopes.rebind(name, Entity::Local(local, QualifiedType { ty: complete, ..ty }));
        out.extend(effects.into_iter().map(|effect| Stmt { kind: StmtKind::Expr(effect), span }));
    }

    /// A variable of the function; aggregates and volatile variables are in memory.
    pub(super) fn add_local(&mut self, name: String, ty: QualifiedType, span: Span) -> LocalId {
        let in_memory = ty.is_volatile || self.types.is_aggregate(ty.ty);
        self.body.locals.push(Local { name, ty: ty.ty, align: 1, in_memory, by_pointer: false, span })
    }

    /// Completes a local whose initialiser determines its array length.
    pub(super) fn complete_local(&mut self, local: LocalId, ty: TypeId) {
        self.body.locals[local].ty = ty;
    }

    /// Warns about the same name twice in a block, or a parameter's name: it is accepted, and the new one applies from
    /// there on.
    fn lint_declared_twice(&mut self, name: Name, span: Span) {
        let (first, what) = if let Some(binding) = self.scopes.lookup_here(name) {
            (binding.span, "is declared twice in one block")
        } else if self.scopes.is_body()
            && let Some(binding) = self.scopes.lookup_around(name)
        {
            (binding.span, "hides a parameter")
        } else {
            return;
        };
        let message = format!("`{}` {what}", self.spelling(name));
        self.report(
            Diagnostic::warning(Lint::Redeclared, span, message)
                .at("a new variable from here on")
                .label(first, "first declared here"),
        );
    }
}
