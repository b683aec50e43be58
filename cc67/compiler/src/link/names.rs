//! Resolution of names to definitions.

use std::collections::BTreeMap;

use super::error::{LinkError, LinkErrorKind};
use crate::object::{Definition, Object, Symbol};
use crate::typed::{Linkage, SymbolId};

/// A definition in one of the objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum DefinitionIndex {
    /// A function: object, index.
    Function(usize, u32),
    /// An initialised object: object, index.
    Data(usize, u32),
    /// An uninitialised object: index into [`Names::uninitialized`].
    Bss(usize),
}

/// An object without initialiser; one for all tentative definitions of an external name.
#[derive(Clone, Copy, Debug)]
pub(super) struct UninitializedObject {
    /// The object that defines it (first).
    pub(super) object: usize,
    /// The symbol there.
    pub(super) symbol: SymbolId,
    /// Its size in bytes: the largest size of all definitions.
    pub(super) size: u32,
    /// Its alignment: the largest alignment of all definitions.
    pub(super) align: u32,
}

/// All definitions.
#[derive(Debug, Default)]
pub(super) struct Names<'a> {
    external: BTreeMap<&'a str, DefinitionIndex>,
    /// The uninitialised objects of a unit itself, by object and symbol.
    internal: BTreeMap<(usize, SymbolId), usize>,
    /// Uninitialised objects, `static` ones first.
    pub(super) uninitialized: Vec<UninitializedObject>,
}

impl<'a> Names<'a> {
    /// Collects the definitions of all objects.
    pub(super) fn collect(objects: &'a [Object]) -> Result<Self, Vec<LinkError>> {
        let mut names = Self::default();
        let mut errors = Vec::new();
        for (index, object) in objects.iter().enumerate() {
            for (id, symbol) in &object.symbols {
                if symbol.linkage == Linkage::Internal && symbol.definition == Definition::Tentative {
                    names.internal.insert((index, id), names.uninitialized.len());
                    names.uninitialized.push(uninitialized(index, id, symbol));
                }
            }
        }
        for (index, object) in objects.iter().enumerate() {
            for (id, symbol) in
                object.symbols.iter().filter(|(_, symbol)| symbol.linkage == Linkage::External)
            {
                errors.extend(names.define(objects, index, id, symbol));
            }
        }
        if errors.is_empty() { Ok(names) } else { Err(errors) }
    }

    /// Records an external definition; an error if there is another one that is not tentative.
    fn define(
        &mut self,
        objects: &[Object],
        object: usize,
        id: SymbolId,
        symbol: &'a Symbol,
    ) -> Option<LinkError> {
        let known = self.external.get(symbol.name.as_str()).copied();
        let new = match (symbol.definition, known) {
            (Definition::None, _)
            | (Definition::Tentative, Some(DefinitionIndex::Function(..) | DefinitionIndex::Data(..))) => {
                return None;
            }
            (Definition::Tentative, Some(DefinitionIndex::Bss(index))) => {
                let known = &mut self.uninitialized[index];
                known.size = known.size.max(symbol.size);
                known.align = known.align.max(symbol.align);
                return None;
            }
            (Definition::Tentative, None) => {
                self.uninitialized.push(uninitialized(object, id, symbol));
                DefinitionIndex::Bss(self.uninitialized.len() - 1)
            }
            (_, Some(first @ (DefinitionIndex::Function(..) | DefinitionIndex::Data(..)))) => {
                let (unit, place) = (&objects[object], symbol.place);
                let kind = LinkErrorKind::DefinedTwice {
                    name: symbol.name.clone(),
                    first: self.place_of(objects, first),
                    second: unit.describe(place),
                };
                return Some(LinkError { object: Some(object), span: symbol.span, kind, users: Vec::new() });
            }
            (Definition::Function(index), _) => DefinitionIndex::Function(object, index),
            (Definition::Data(index), _) => DefinitionIndex::Data(object, index),
        };
        self.external.insert(&symbol.name, new);
        None
    }

    /// File and line of a definition.
    fn place_of(&self, objects: &[Object], defined: DefinitionIndex) -> String {
        let (object, symbol) = match defined {
            DefinitionIndex::Function(object, index) => {
                (object, objects[object].functions[index as usize].symbol)
            }
            DefinitionIndex::Data(object, index) => (object, objects[object].objects[index as usize].symbol),
            DefinitionIndex::Bss(index) => {
                let found = &self.uninitialized[index];
                (found.object, found.symbol)
            }
        };
        objects[object].describe(objects[object].symbols[symbol].place)
    }

    /// Returns the definition of an object's symbol inside the program; `None` if no object defines it.
    pub(super) fn find(&self, object: usize, id: SymbolId, symbol: &Symbol) -> Option<DefinitionIndex> {
        match (symbol.linkage, symbol.definition) {
            (Linkage::External, _) => self.external.get(symbol.name.as_str()).copied(),
            (Linkage::Internal, Definition::Function(index)) => {
                Some(DefinitionIndex::Function(object, index))
            }
            (Linkage::Internal, Definition::Data(index)) => Some(DefinitionIndex::Data(object, index)),
            (Linkage::Internal, Definition::Tentative) => {
                self.internal.get(&(object, id)).map(|index| DefinitionIndex::Bss(*index))
            }
            (Linkage::Internal, Definition::None) => None,
        }
    }

    /// Every external name, for suggestions.
    pub(super) fn external_names(&self) -> impl Iterator<Item = &'a str> + '_ {
        self.external.keys().copied()
    }

    /// The function `main`, which may be `static`.
    pub(super) fn main(&self, objects: &[Object]) -> Option<(usize, u32)> {
        if let Some(DefinitionIndex::Function(object, index)) = self.external.get("main") {
            return Some((*object, *index));
        }
        objects.iter().enumerate().find_map(|(object, unit)| {
            unit.symbols.values().find_map(|symbol| match symbol.definition {
                Definition::Function(index) if symbol.name == "main" => Some((object, index)),
                _ => None,
            })
        })
    }
}

fn uninitialized(object: usize, id: SymbolId, symbol: &Symbol) -> UninitializedObject {
    UninitializedObject { object, symbol: id, size: symbol.size, align: symbol.align }
}
