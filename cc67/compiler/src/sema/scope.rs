//! Scopes: the declaration to which a name refers at a position.
//!
//! The bindings of a name form a chain from the innermost outwards; leaving a block unwinds the bindings it made. All
//! file-scope declarations are bound before the first body is analysed, so each carries the number of its item, and a
//! body only sees declarations up to its own item.

use cranelift_entity::SecondaryMap;

use crate::names::Name;
use crate::source::Span;
use crate::ty::{QualifiedType, TypeId};
use crate::typed::{LocalId, SymbolId};

/// The meaning of an ordinary identifier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Entity {
    /// A type.
    Typedef(QualifiedType),
    /// A constant of type `int`.
    Enumerator(i32),
    /// A local variable or parameter.
    Local(LocalId, QualifiedType),
    /// An object with an address at link time, with the type known here.
    Object(SymbolId, QualifiedType),
    /// A function, with the type declared here.
    Function(SymbolId, TypeId),
    /// A name whose declaration was diagnosed; uses are silent.
    Poisoned,
}

/// The meaning of a tag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Tag {
    /// A structure or union.
    Record(TypeId),
    /// An enumeration; its type is `int`.
    Enum,
}

/// A declaration of a name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binding<E> {
    /// The name.
    pub(super) name: Name,
    /// The meaning.
    pub(super) entity: E,
    /// The range of the declaration.
    pub(super) span: Span,
    /// Nesting depth of its scope; 0 is file scope.
    depth: u32,
    /// The item that declares it, at file scope.
    since: u32,
    /// The binding that it hides.
    hidden: Link,
}

/// The number of a binding, or [`NONE`].
type Link = u32;
const NONE: Link = u32::MAX;

/// The bindings of one name space.
#[derive(Debug)]
pub(super) struct NameSpace<E> {
    heads: SecondaryMap<Name, Link>,
    bindings: Vec<Binding<E>>,
}

impl<E: Copy> NameSpace<E> {
    fn new() -> Self {
        Self { heads: SecondaryMap::with_default(NONE), bindings: Vec::new() }
    }

    fn push(&mut self, binding: Binding<E>) {
        let link = self.bindings.len() as Link;
        self.bindings.push(Binding { hidden: self.heads[binding.name], ..binding });
        self.heads[binding.name] = link;
    }

    /// The bindings of a name from the innermost outwards.
    fn bindings_of(&self, name: Name) -> impl Iterator<Item = &Binding<E>> {
        let at = |link: Link| self.bindings.get(link as usize);
        std::iter::successors(at(self.heads[name]), move |binding| at(binding.hidden))
    }

    /// Drops the bindings after the first `length`, in the order of their declaration.
    fn unwind(&mut self, length: usize) -> Vec<Binding<E>> {
        for binding in self.bindings.get(length..).unwrap_or_default().iter().rev() {
            self.heads[binding.name] = binding.hidden;
        }
        self.bindings.split_off(length)
    }
}

/// Every scope that is open.
#[derive(Debug)]
pub(super) struct Scopes {
    ordinary: NameSpace<Entity>,
    tags: NameSpace<Tag>,
    /// For each open block, the numbers of bindings when it was opened.
    blocks: Vec<(usize, usize)>,
    /// The item being analysed.
    now: u32,
}

/// The bindings of a parameter list, kept until the body is analysed.
#[derive(Debug, Default)]
pub(super) struct ClosedScope {
    ordinary: Vec<Binding<Entity>>,
    tags: Vec<Binding<Tag>>,
}

impl Scopes {
    pub(super) fn new() -> Self {
        Self { ordinary: NameSpace::new(), tags: NameSpace::new(), blocks: Vec::new(), now: 0 }
    }

    /// Sets the file scope to the declarations that item number `item` sees.
    pub(super) fn at_item(&mut self, item: usize) {
        self.now = item as u32;
    }

    /// Opens a block or parameter list.
    pub(super) fn enter(&mut self) {
        self.blocks.push((self.ordinary.bindings.len(), self.tags.bindings.len()));
    }

    /// Closes the innermost block.
    pub(super) fn leave(&mut self) -> ClosedScope {
        let (ordinary, tags) = self.blocks.pop().unwrap_or_default();
        ClosedScope { ordinary: self.ordinary.unwind(ordinary), tags: self.tags.unwind(tags) }
    }

    /// Opens a block with the bindings of one that was closed.
    pub(super) fn reopen(&mut self, closed: ClosedScope) {
        self.enter();
        closed.ordinary.into_iter().for_each(|binding| self.ordinary.push(binding));
        closed.tags.into_iter().for_each(|binding| self.tags.push(binding));
    }

    /// Reports whether the innermost scope is a function's body: around it are the parameters.
    pub(super) fn is_body(&self) -> bool {
        self.blocks.len() == 2
    }

    /// Declares a name in the innermost scope.
    pub(super) fn bind(&mut self, name: Name, entity: Entity, span: Span) {
        let (depth, since) = (self.depth(), self.now);
        self.ordinary.push(Binding { name, entity, span, depth, since, hidden: NONE });
    }

    /// Declares a tag in the innermost scope.
    pub(super) fn bind_tag(&mut self, name: Name, tag: Tag, span: Span) {
        let (depth, since) = (self.depth(), self.now);
        self.tags.push(Binding { name, entity: tag, span, depth, since, hidden: NONE });
    }

    /// Gives the visible declaration of a name, just made by [`Self::bind`], another meaning.
    pub(super) fn rebind(&mut self, name: Name, entity: Entity) {
        let link = self.ordinary.heads[name] as usize;
        if let Some(binding) = self.ordinary.bindings.get_mut(link) {
            binding.entity = entity;
        }
    }

    /// The visible declaration of a name.
    pub(super) fn lookup(&self, name: Name) -> Option<&Binding<Entity>> {
        self.ordinary.bindings_of(name).find(|binding| self.is_visible(binding))
    }

    /// The declaration of a name in the innermost scope.
    pub(super) fn lookup_here(&self, name: Name) -> Option<&Binding<Entity>> {
        self.lookup(name).filter(|binding| binding.depth == self.depth())
    }

    /// The declaration in the scope around the innermost one.
    pub(super) fn lookup_around(&self, name: Name) -> Option<&Binding<Entity>> {
        self.lookup(name).filter(|binding| binding.depth + 1 == self.depth())
    }

    /// A file-scope declaration after the present item.
    pub(super) fn lookup_later(&self, name: Name) -> Option<&Binding<Entity>> {
        self.ordinary.bindings_of(name).find(|binding| binding.depth == 0 && binding.since > self.now)
    }

    /// The visible declaration of a tag.
    pub(super) fn lookup_tag(&self, name: Name) -> Option<&Binding<Tag>> {
        self.tags.bindings_of(name).find(|binding| self.is_visible(binding))
    }

    /// The declaration of a tag in the innermost scope.
    pub(super) fn lookup_tag_here(&self, name: Name) -> Option<&Binding<Tag>> {
        self.lookup_tag(name).filter(|binding| binding.depth == self.depth())
    }

    /// Every name that is declared and visible.
    pub(super) fn visible(&self) -> impl Iterator<Item = &Binding<Entity>> {
        self.ordinary.bindings.iter().filter(|binding| self.is_visible(binding))
    }

    fn depth(&self) -> u32 {
        self.blocks.len() as u32
    }

    fn is_visible<E>(&self, binding: &Binding<E>) -> bool {
        binding.depth > 0 || binding.since <= self.now
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::Names;

    #[test]
    fn blocks_shadow_and_restore_names_and_file_scope_is_in_item_order() {
        let mut names = Names::new();
        let (a, span) = (names.intern("a"), Span::new(0, 0));
        let mut scopes = Scopes::new();
        let value = |scopes: &Scopes| scopes.lookup(a).map(|binding| binding.entity);
        scopes.at_item(1);
        scopes.bind(a, Entity::Enumerator(1), span);
        scopes.at_item(3);
        scopes.bind(a, Entity::Enumerator(3), span);
        assert_eq!(value(&scopes), Some(Entity::Enumerator(3)));
        scopes.at_item(0);
        assert_eq!(value(&scopes), None);
        assert!(scopes.lookup_later(a).is_some());
        scopes.at_item(2);
        scopes.enter();
        assert_eq!(value(&scopes), Some(Entity::Enumerator(1)));
        scopes.bind(a, Entity::Poisoned, span);
        assert_eq!(value(&scopes), Some(Entity::Poisoned));
        let closed = scopes.leave();
        assert_eq!(value(&scopes), Some(Entity::Enumerator(1)));
        scopes.reopen(closed);
        assert_eq!(value(&scopes), Some(Entity::Poisoned));
    }
}
