//! Structures and unions.

use super::Sema;
use super::scope::Tag;
use super::specifiers::ImplicitInt;
use crate::ast::{Expression, MemberDeclaration, MemberDeclarator, RecordKind, RecordSpecifier};
use crate::diag::Diagnostic;
use crate::names::Name;
use crate::source::Span;
use crate::ty::layout::{LayoutBuilder, MAX_OBJECT_SIZE};
use crate::ty::{Layout, QualifiedType, RecordId, TypeId, Types};

/// The limit of members of a structure; each is compared with all earlier ones.
const MEMBERS: usize = 10_000;

impl Sema<'_> {
    /// The type of `struct tag`, `struct tag { … }` or `struct { … }`.
    pub(super) fn record(&mut self, specifier: &RecordSpecifier) -> Option<TypeId> {
        match &specifier.members {
            Some(members) => self.define_record(specifier, members),
            None => {
                let (tag, span) = specifier.tag?;
                self.refer_to_record(specifier.kind, tag, span)
            }
        }
    }

    fn refer_to_record(&mut self, kind: RecordKind, tag: Name, span: Span) -> Option<TypeId> {
        match self.scopes.lookup_tag(tag).map(|binding| (binding.entity, binding.span)) {
            Some((Tag::Record(ty), first)) => self.check_kind(ty, kind, tag, span, first),
            Some((Tag::Enum, first)) => {
                let message = format!("`{}` is an enumeration, not a structure or union", self.spelling(tag));
                self.report(Diagnostic::error(span, message).label(first, "declared here"));
                None
            }
            None => Some(self.open_record(kind, Some((tag, span))).1),
        }
    }

    /// A `struct` stays one.
    fn check_kind(
        &mut self,
        ty: TypeId,
        kind: RecordKind,
        tag: Name,
        span: Span,
        first: Span,
    ) -> Option<TypeId> {
        let record = self.types.record_of(ty)?;
        if self.types.record(record).kind == kind {
            return Some(ty);
        }
        let message = format!("`{}` is declared as `struct` and as `union`", self.spelling(tag));
        self.report(Diagnostic::error(span, message).label(first, "declared here"));
        None
    }

    /// A new record without members, its tag declared in the innermost scope.
    fn open_record(&mut self, kind: RecordKind, tag: Option<(Name, Span)>) -> (RecordId, TypeId) {
        let (record, ty) = self.types.add_record(kind, tag.map(|(name, _)| name));
        if let Some((name, span)) = tag {
            self.scopes.bind_tag(name, Tag::Record(ty), span);
        }
        (record, ty)
    }

    fn define_record(
        &mut self,
        specifier: &RecordSpecifier,
        members: &[MemberDeclaration],
    ) -> Option<TypeId> {
        let known =
            specifier.tag.and_then(|(tag, _)| self.scopes.lookup_tag_here(tag)).map(|b| (b.entity, b.span));
        let (known, first) = match (known, specifier.tag) {
            (Some((Tag::Record(ty), first)), Some((tag, span))) => {
                (Some(self.check_kind(ty, specifier.kind, tag, span, first)?), first)
            }
            (Some((Tag::Enum, first)), Some((tag, span))) => {
                let message = format!("`{}` is already an enumeration", self.spelling(tag));
                self.report(Diagnostic::error(span, message).label(first, "declared here"));
                return None;
            }
            _ => (None, specifier.span),
        };
        let (ty, record) = match known.and_then(|ty| Some((ty, self.types.record_of(ty)?))) {
            Some(known) => known,
            None => {
                let (record, ty) = self.open_record(specifier.kind, specifier.tag);
                (ty, record)
            }
        };
        let layout = self.layout(specifier, members, record);
        self.complete_record(specifier, record, layout, first);
        Some(ty)
    }

    /// Gives a record its members; a second definition must be the same (`dialect.md` 2.2).
    fn complete_record(
        &mut self,
        specifier: &RecordSpecifier,
        record: RecordId,
        layout: Layout,
        first: Span,
    ) {
        let is_other = self.types.record(record).layout.as_ref().is_some_and(|known| *known != layout);
        if is_other {
            let tag = specifier.tag.map_or("", |(tag, _)| self.names.get(tag)).to_owned();
            let span = specifier.tag.map_or(specifier.span, |(_, span)| span);
            self.report(
                Diagnostic::error(span, format!("`{tag}` is redefined with different members"))
                    .label(first, "first definition"),
            );
            return;
        }
        self.types.record_mut(record).layout = Some(layout);
    }

    /// The layout of the members that are right.
    fn layout(
        &mut self,
        specifier: &RecordSpecifier,
        members: &[MemberDeclaration],
        record: RecordId,
    ) -> Layout {
        let mut builder = LayoutBuilder::new(specifier.kind);
        builder.align(self.alignment(&specifier.alignments));
        for line in members {
            if builder.members().len() > MEMBERS {
                let message = format!("more than {MEMBERS} members");
                self.report(Diagnostic::error(line.span, message).at("the rest is left out"));
                self.noted.broken.insert(record);
                break;
            }
            if self.member_line(&mut builder, line).is_none() {
                self.noted.broken.insert(record);
            }
        }
        builder.finish()
    }

    fn member_line(&mut self, builder: &mut LayoutBuilder, line: &MemberDeclaration) -> Option<()> {
        let base = self.specified_type(&line.specifiers, ImplicitInt::Warn)?;
        let align = self.alignment(&line.specifiers.alignments);
        if line.members.is_empty() {
            let Some(record) = self.types.record_of(base.ty) else {
                self.report(Diagnostic::error(line.span, "a member needs a name"));
                return None;
            };
            // `struct tag;` or a tagged definition inside declares a type, not a member.
            if self.types.record(record).is_tagged {
                return Some(());
            }
            self.check_inner_names(builder, record, line.span)?;
            return self.place_member(builder, None, base, align, line.span);
        }
        let mut is_sound = true;
        let is_enum = line.specifiers.ty.as_ref().is_some_and(|ty| self.is_unsigned_enum(ty));
        let field = QualifiedType { ty: if is_enum { Types::UNSIGNED } else { base.ty }, ..base };
        for member in &line.members {
            let base = if member.width.is_some() { field } else { base };
            is_sound &= self.member(builder, base, align, member, line.span).is_some();
        }
        is_sound.then_some(())
    }

    fn member(
        &mut self,
        builder: &mut LayoutBuilder,
        base: QualifiedType,
        align: u32,
        member: &MemberDeclarator,
        line: Span,
    ) -> Option<()> {
        let (ty, named) = match &member.declarator {
            Some(declarator) => {
                (self.derived_type(base, &declarator.derived, declarator.span)?, declarator.name)
            }
            None => (base, None),
        };
        let span = named.map_or(line, |(_, span)| span);
        let name = named.map(|(name, _)| name);
        self.check_new(builder, name, span)?;
        match &member.width {
            Some(width) => self.bit_field(builder, name, ty, width, span),
            None => {
                let own = member.declarator.as_ref().map_or(1, |own| self.alignment(&own.alignments));
                self.place_member(builder, name, ty, align.max(own), span)
            }
        }
    }

    fn place_member(
        &mut self,
        builder: &mut LayoutBuilder,
        name: Option<Name>,
        ty: QualifiedType,
        align: u32,
        span: Span,
    ) -> Option<()> {
        // An array without length is flexible and takes no room.
        let is_flexible = self
            .types
            .array(ty.ty)
            .is_some_and(|(element, length)| length.is_none() && self.types.is_object(element.ty));
        if !is_flexible && !self.types.is_object(ty.ty) {
            let spelled = self.spell(ty.ty);
            self.report(Diagnostic::error(span, format!("a member cannot have the type `{spelled}`")));
            return None;
        }
        let placed = builder.member(&self.types, name, ty, align);
        if placed.is_none() {
            self.report(
                Diagnostic::error(span, "the structure is too large")
                    .note(format!("the limit is {MAX_OBJECT_SIZE} bytes")),
            );
        }
        placed
    }

    fn bit_field(
        &mut self,
        builder: &mut LayoutBuilder,
        name: Option<Name>,
        ty: QualifiedType,
        width: &Expression,
        span: Span,
    ) -> Option<()> {
        if !ty.ty.is_integer() {
            let spelled = self.spell(ty.ty);
            self.report(
                Diagnostic::error(span, format!("a bit-field cannot have the type `{spelled}`"))
                    .help("use an integer type, such as `int` or `unsigned`"),
            );
            return None;
        }
        let value = self.constant_integer(width, "the width of a bit-field")?;
        let limit = if ty.ty == Types::BOOL { 1 } else { i64::from(self.types.size_of(ty.ty)?) * 8 };
        let lowest = i64::from(name.is_some());
        if !(lowest..=limit).contains(&value) {
            let spelled = self.spell(ty.ty);
            self.report(
                Diagnostic::error(
                    width.span,
                    format!("a bit-field of type `{spelled}` cannot be {value} bits wide"),
                )
                .at(format!("allowed are {lowest} to {limit}")),
            );
            return None;
        }
        builder.bit_field(&self.types, name, ty, u32::try_from(value).ok()?)
    }

    /// Refuses a member name that the record has already.
    fn check_new(&mut self, builder: &LayoutBuilder, name: Option<Name>, span: Span) -> Option<()> {
        let Some(name) = name else { return Some(()) };
        let is_taken = builder.members().iter().any(|member| match member.name {
            Some(own) => own == name,
            None => self
                .types
                .record_of(member.ty.ty)
                .is_some_and(|inner| self.types.find_member(inner, name).is_some()),
        });
        if is_taken {
            let message = format!("duplicate member `{}`", self.spelling(name));
            self.report(Diagnostic::error(span, message));
            return None;
        }
        Some(())
    }

    /// Checks the members of an anonymous structure, which are also members of the enclosing one.
    fn check_inner_names(&mut self, builder: &LayoutBuilder, inner: RecordId, span: Span) -> Option<()> {
        let names: Vec<_> = self
            .types
            .record(inner)
            .layout
            .iter()
            .flat_map(|layout| layout.members.iter().filter_map(|member| member.name))
            .collect();
        names.into_iter().try_for_each(|name| self.check_new(builder, Some(name), span))
    }
}
