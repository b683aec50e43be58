//! Functions, blocks and signatures.

use std::collections::BTreeMap;

use cranelift_entity::{EntityRef, PrimaryMap, SecondaryMap};

use super::inst::{
    BlockId, Class, CodeOrigin, InlineId, Inst, Operand, SignatureId, SlotId, Terminator, ValueId,
};
use crate::source::Span;
use crate::typed::{LocalId, SymbolId};

/// A map with room for the keys below `len`; growing it key by key takes longer than most passes.
#[must_use]
pub fn table<K: EntityRef, V: Clone + Default>(len: usize) -> SecondaryMap<K, V> {
    let mut table = SecondaryMap::new();
    table.resize(len);
    table
}

/// The signature of a function, as classes.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signature {
    /// The parameters, including hidden ones.
    pub params: Vec<Class>,
    /// Result; `None` for `void`.
    pub result: Option<Class>,
}

/// Every signature of a unit, each once.
#[derive(Clone, Debug, Default)]
pub struct Signatures {
    table: PrimaryMap<SignatureId, Signature>,
    numbers: BTreeMap<Signature, SignatureId>,
}

impl Signatures {
    /// The number of a signature, new if it was not seen before.
    pub fn intern(&mut self, signature: &Signature) -> SignatureId {
        if let Some(id) = self.numbers.get(signature) {
            return *id;
        }
        let id = self.table.push(signature.clone());
        self.numbers.insert(signature.clone(), id);
        id
    }

    /// The number of a signature that was seen before.
    #[must_use]
    pub fn find(&self, signature: &Signature) -> Option<SignatureId> {
        self.numbers.get(signature).copied()
    }

    /// The signature with this number.
    #[must_use]
    pub fn get(&self, id: SignatureId) -> &Signature {
        &self.table[id]
    }

    /// All signatures in the order of their numbers.
    #[must_use]
    pub fn as_slice(&self) -> &[Signature] {
        self.table.values().as_slice()
    }
}

/// An object in the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSlot {
    /// Bytes.
    pub size: u32,
    /// Alignment, at most 8.
    pub align: u32,
}

/// A basic block.
#[derive(Clone, Debug)]
pub struct Block {
    /// Instructions in order.
    pub insts: Vec<Inst>,
    /// Its terminator.
    pub terminator: Terminator,
    /// The statement of its end.
    pub origin: CodeOrigin,
}

/// A local of the source, and its home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceVariable {
    /// The local.
    pub local: LocalId,
    /// Its home.
    pub home: VariableHome,
}

/// The home of a local.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableHome {
    /// In a value that was written this many times when the function was lowered.
    Value(ValueId, u32),
    /// In the frame.
    Slot(SlotId),
    /// In memory, at the address in a value.
    Pointer(ValueId),
    /// It has no location, but always this value, given as the bits of a register.
    Constant(u64),
}

/// An inlined call.
#[derive(Clone, Debug)]
pub struct InlinedCall {
    /// The called function.
    pub callee: SymbolId,
    /// The position of the call in the source.
    pub origin: CodeOrigin,
    /// The homes of its locals.
    pub variables: Vec<SourceVariable>,
}

/// The locals of the source in a function.
#[derive(Clone, Debug, Default)]
pub struct SourceLocals {
    /// The homes of its own locals.
    pub variables: Vec<SourceVariable>,
    /// The inlined calls, with theirs.
    pub inlined: PrimaryMap<InlineId, InlinedCall>,
}

/// A function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its symbol.
    pub symbol: SymbolId,
    /// Its signature.
    pub signature: SignatureId,
    /// The values that receive the arguments.
    pub params: Vec<ValueId>,
    /// The class of every value.
    pub values: PrimaryMap<ValueId, Class>,
    /// Objects in the frame.
    pub slots: PrimaryMap<SlotId, FrameSlot>,
    /// The object that holds the variable arguments of calls.
    pub outgoing: Option<SlotId>,
    /// All blocks, including those dropped from `layout`.
    pub blocks: PrimaryMap<BlockId, Block>,
    /// The blocks that exist, in the order of the code; the first is the entry.
    pub layout: Vec<BlockId>,
    /// Arguments of the calls, one range a call.
    pub arguments: Vec<Operand>,
    /// The function's name in its definition.
    pub span: Span,
    /// Its closing brace.
    pub end: Span,
    /// The homes of the source's locals, for debuggers.
    pub source: SourceLocals,
}

impl Function {
    /// Makes a function without blocks.
    #[must_use]
    pub fn new(symbol: SymbolId, signature: SignatureId, span: Span, end: Span) -> Self {
        Self {
            symbol,
            signature,
            params: Vec::new(),
            values: PrimaryMap::new(),
            slots: PrimaryMap::new(),
            outgoing: None,
            blocks: PrimaryMap::new(),
            layout: Vec::new(),
            arguments: Vec::new(),
            span,
            end,
            source: SourceLocals::default(),
        }
    }

    /// Number of writes of each value by instructions.
    #[must_use]
    pub fn writes(&self) -> SecondaryMap<ValueId, u32> {
        let mut writes = table(self.values.len());
        let insts = self.layout.iter().flat_map(|id| &self.blocks[*id].insts);
        insts.filter_map(|inst| inst.kind.dst()).for_each(|dst| writes[dst] += 1);
        writes
    }

    /// The class of an operand.
    #[must_use]
    pub fn class(&self, operand: Operand) -> Class {
        match operand {
            Operand::Value(value) => self.values[value],
            Operand::Constant(constant) => constant.class(),
        }
    }

    /// Number of edges that lead to each block; the entry has one more.
    #[must_use]
    pub fn predecessors(&self) -> SecondaryMap<BlockId, u32> {
        let mut counts = table(self.blocks.len());
        if let Some(&entry) = self.layout.first() {
            counts[entry] = 1;
        }
        for &id in &self.layout {
            for target in self.blocks[id].terminator.targets() {
                counts[target] += 1;
            }
        }
        counts
    }

    /// Reports whether `before` is the only predecessor of `block`, so that facts at its end still hold.
    #[must_use]
    pub fn is_only_way(
        &self,
        before: Option<BlockId>,
        block: BlockId,
        predecessors: &SecondaryMap<BlockId, u32>,
    ) -> bool {
        before.is_some_and(|before| {
            predecessors[block] == 1 && self.blocks[before].terminator.targets().any(|to| to == block)
        })
    }
}
