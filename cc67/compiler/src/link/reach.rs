//! Finds the functions and objects that belong to the program, and the firmware symbols that it needs.
//!
//! It follows the relocations from `main`, or from every definition if nothing should be left out. The target of a
//! relocation is resolved here, once for each symbol of an object.

use std::collections::{BTreeMap, VecDeque};

use cranelift_entity::SecondaryMap;
use kmotiondef::GuestAddr;
use kmotiondef::jumps::JumpFunction;

use super::error::{LinkError, LinkErrorKind};
use super::names::{DefinitionIndex, Names};
use super::{Import, Options};
use crate::firmware::{FirmwareKind, FirmwareSymbol};
use crate::ir::function::Signature;
use crate::ir::inst::Class;
use crate::object::Object;
use crate::target;
use crate::typed::SymbolId;
use crate::words::suggest;

/// The target of an object's symbol.
#[derive(Clone, Debug, Default)]
pub(super) enum Target {
    /// It is not referred to, or not defined.
    #[default]
    Unknown,
    /// A definition of the program.
    Program(DefinitionIndex),
    /// A function of the firmware.
    Function(GuestAddr, Option<Signature>),
    /// A variable of the firmware.
    Variable(GuestAddr),
}

/// The parts of the program.
#[derive(Debug)]
pub(super) struct ReachableParts {
    /// The targets of each object's symbols.
    pub(super) targets: Vec<SecondaryMap<SymbolId, Target>>,
    /// True for the functions of each object that are needed.
    pub(super) functions: Vec<Vec<bool>>,
    /// True for the initialised objects of each object that are needed.
    pub(super) data: Vec<Vec<bool>>,
    /// True for the uninitialised objects that are needed.
    pub(super) bss: Vec<bool>,
    /// `main`: object and index.
    pub(super) main: (usize, u32),
    /// The functions and variables of the firmware that are needed, by name.
    pub(super) imports: Vec<Import>,
}

/// Finds out.
pub(super) fn reach(
    objects: &[Object],
    names: &Names<'_>,
    options: &Options<'_>,
) -> Result<ReachableParts, Vec<LinkError>> {
    let main = names.main(objects);
    let mut walk = Walk {
        objects,
        names,
        options,
        reached: ReachableParts {
            targets: objects.iter().map(|_| SecondaryMap::new()).collect(),
            functions: objects.iter().map(|object| vec![false; object.functions.len()]).collect(),
            data: objects.iter().map(|object| vec![false; object.objects.len()]).collect(),
            bss: vec![false; names.uninitialized.len()],
            main: main.unwrap_or_default(),
            imports: Vec::new(),
        },
        imports: BTreeMap::new(),
        missing: BTreeMap::new(),
        pending: VecDeque::new(),
    };
    if let Some((object, index)) = main {
        walk.mark_needed(DefinitionIndex::Function(object, index));
    }
    if !options.gc || main.is_none() {
        walk.need_all();
    }
    walk.run();
    let mut errors: Vec<LinkError> = walk.missing.into_values().collect();
    errors.sort_by_key(|error| (error.object, error.span.map(|span| span.lo)));
    if main.is_none() {
        errors.push(LinkError::global(LinkErrorKind::NoMain));
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    walk.reached.imports = walk.imports.into_values().collect();
    Ok(walk.reached)
}

struct Walk<'a> {
    objects: &'a [Object],
    names: &'a Names<'a>,
    options: &'a Options<'a>,
    reached: ReachableParts,
    imports: BTreeMap<&'a str, Import>,
    missing: BTreeMap<&'a str, LinkError>,
    /// Definitions whose relocations have not been followed yet.
    pending: VecDeque<DefinitionIndex>,
}

impl Walk<'_> {
    fn need_all(&mut self) {
        for (object, unit) in self.objects.iter().enumerate() {
            (0..unit.functions.len())
                .for_each(|index| self.mark_needed(DefinitionIndex::Function(object, index as u32)));
            (0..unit.objects.len())
                .for_each(|index| self.mark_needed(DefinitionIndex::Data(object, index as u32)));
        }
        self.reached.bss.fill(true);
    }

    fn mark_needed(&mut self, defined: DefinitionIndex) {
        let needed = match defined {
            DefinitionIndex::Function(object, index) => &mut self.reached.functions[object][index as usize],
            DefinitionIndex::Data(object, index) => &mut self.reached.data[object][index as usize],
            DefinitionIndex::Bss(index) => &mut self.reached.bss[index],
        };
        if !*needed {
            *needed = true;
            self.pending.push_back(defined);
        }
    }

    fn run(&mut self) {
        while let Some(defined) = self.pending.pop_front() {
            match defined {
                DefinitionIndex::Function(object, index) => {
                    let unit = &self.objects[object];
                    let range = unit.functions[index as usize].relocations.clone();
                    for relocation in &unit.relocations[range.start as usize..range.end as usize] {
                        self.refer(object, relocation.symbol, User::Word(index, relocation.word));
                    }
                }
                DefinitionIndex::Data(object, index) => {
                    let unit = &self.objects[object];
                    let range = unit.objects[index as usize].relocations.clone();
                    for relocation in &unit.data_relocations[range.start as usize..range.end as usize] {
                        self.refer(object, relocation.symbol, User::Data(index));
                    }
                }
                DefinitionIndex::Bss(_) => {}
            }
        }
    }

    /// Resolves a symbol, and marks its definition as needed.
    fn refer(&mut self, object: usize, id: SymbolId, user: User) {
        if !matches!(self.reached.targets[object][id], Target::Unknown) {
            return;
        }
        let symbol = &self.objects[object].symbols[id];
        let target = if let Some(defined) = self.names.find(object, id, symbol) {
            self.mark_needed(defined);
            Target::Program(defined)
        } else if let Some(FirmwareSymbol { address, kind }) = self.options.firmware.find(&symbol.name) {
            let is_function = matches!(kind, FirmwareKind::Function(_));
            self.imports.entry(&symbol.name).or_insert_with(|| Import {
                name: symbol.name.clone(),
                address,
                is_function,
            });
            match kind {
                FirmwareKind::Variable => Target::Variable(address),
                FirmwareKind::Function(signature) => Target::Function(address, signature),
            }
        } else if let Some(function) = self.jump(&symbol.name) {
            let (name, address) = (symbol.name.clone(), function.address());
            let import = Import { name, address, is_function: true };
            self.imports.entry(&symbol.name).or_insert(import);
            let params = vec![Class::I32; function.parameters()];
            let result = function.has_result().then_some(Class::I32);
            Target::Function(address, Some(Signature { params, result }))
        } else {
            self.record_undefined(object, id, user);
            Target::Unknown
        };
        self.reached.targets[object][id] = target;
    }

    /// `setjmp` or `longjmp`, which the engines of bytecode have.
    fn jump(&self, name: &str) -> Option<JumpFunction> {
        JumpFunction::named(name)
            .filter(|_| self.objects.iter().all(|object| object.target() == target::Target::Sim))
    }

    /// Records an undefined symbol, once for each name, with all of its users.
    fn record_undefined(&mut self, object: usize, id: SymbolId, user: User) {
        let unit = &self.objects[object];
        let symbol = &unit.symbols[id];
        let user = user.describe(unit);
        if let Some(known) = self.missing.get_mut(symbol.name.as_str()) {
            if !known.users.contains(&user) {
                known.users.push(user);
            }
            return;
        }
        let candidates = self.names.external_names().chain(self.options.firmware.symbol_names());
        let suggestion = suggest(&symbol.name, candidates).map(str::to_owned);
        let other = self.options.firmware.board().other_with(&symbol.name);
        let kind = LinkErrorKind::Undefined { name: symbol.name.clone(), suggestion, other };
        let span = symbol.used_at.or(symbol.span);
        let error = LinkError { object: Some(object), span, kind, users: vec![user] };
        self.missing.insert(&symbol.name, error);
    }
}

/// A user of a symbol.
#[derive(Clone, Copy)]
enum User {
    /// A word of a function.
    Word(u32, u32),
    /// An initialised object.
    Data(u32),
}

impl User {
    fn describe(self, unit: &Object) -> String {
        let (symbol, place) = match self {
            Self::Word(function, word) => {
                let function = &unit.functions[function as usize];
                (function.symbol, unit.describe_word(function, word))
            }
            Self::Data(object) => {
                let symbol = unit.objects[object as usize].symbol;
                (symbol, unit.describe(unit.symbols[symbol].place))
            }
        };
        format!("`{}` ({place})", unit.symbols[symbol].name)
    }
}
