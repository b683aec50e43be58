//! Reads the lines of a function, and makes the checks that need all of its lines.

use std::collections::BTreeMap;

use cranelift_entity::{EntityRef, PrimaryMap};

use super::super::classes::Classes;
use super::super::function::{Block, FrameSlot, Function, Signature, Signatures};
use super::super::inst::{
    BlockId, Class, CodeOrigin, Inst, InstKind, Operand, SignatureId, SlotId, Terminator, ValueId,
};
use super::super::verify;
use super::cursor::{Cursor, number};
use super::inst::{self, Content};
use super::{Functions, ParseError, Symbols};
use crate::source::Span;

/// A result, or the error in the line.
pub(super) type LineResult<T> = Result<T, String>;

/// No place in a source: the text of a function has no positions.
const NOWHERE: Span = Span::new(0, 0);

/// A block, with the numbers of its lines.
#[derive(Debug, Default)]
struct BlockLines {
    insts: Vec<Inst>,
    /// The line of each instruction, then that of the terminator.
    numbers: Vec<usize>,
    terminator: Option<Terminator>,
    /// Calls: the place among the instructions, and the class of the result.
    calls: Vec<(usize, Option<Class>)>,
    /// The line with the block's name.
    begins: usize,
}

/// A function that is being read.
#[derive(Debug)]
pub(super) struct Body {
    pub(super) function: Function,
    pub(super) classes: Classes,
    result: Option<Class>,
    blocks: BTreeMap<BlockId, BlockLines>,
    open: Option<BlockId>,
    /// The line of each value's first mention.
    values: BTreeMap<ValueId, usize>,
    /// The line of each jump target's first mention.
    targets: BTreeMap<BlockId, usize>,
    /// The classes that comparisons demand of their operands.
    compared: Vec<(Operand, Class, usize)>,
    /// The line with the function's name.
    begins: usize,
    /// The line that is being read.
    at: usize,
}

impl Body {
    /// Reads the text after the word `function`.
    pub(super) fn read_head(line: &mut Cursor<'_>, at: usize, unit: &mut Functions) -> LineResult<Self> {
        let name = line.word()?;
        let symbol = unit.symbols.intern(name.strip_prefix('@').unwrap_or(name));
        let mut body = Self {
            function: Function::new(symbol, SignatureId::from_u32(0), NOWHERE, NOWHERE),
            classes: Classes::default(),
            result: None,
            blocks: BTreeMap::new(),
            open: None,
            values: BTreeMap::new(),
            targets: BTreeMap::new(),
            compared: Vec::new(),
            begins: at,
            at,
        };
        line.expect("(")?;
        while !line.eat(")") {
            if !body.function.params.is_empty() {
                line.expect(",")?;
            }
            let value = line.entity("v")?;
            line.expect(":")?;
            body.record_mention(value);
            body.record_class(value, line.class()?)?;
            body.function.params.push(value);
        }
        if line.eat("->") {
            body.result = Some(line.class()?);
        }
        Ok(body)
    }

    /// Reads a line of the function.
    pub(super) fn line(&mut self, line: &mut Cursor<'_>, at: usize, symbols: &mut Symbols) -> LineResult<()> {
        self.at = at;
        let mut ahead = *line;
        let word = ahead.word()?;
        if ahead.eat(":") {
            *line = ahead;
            return self.declaration(word, line);
        }
        let content = inst::read_line(line, self, symbols)?;
        let id = self.open.ok_or("this is not in a block")?;
        let block = self.blocks.entry(id).or_default();
        block.numbers.push(at);
        match content {
            Content::Inst(kind) => block.insts.push(Inst { kind, origin: CodeOrigin::of(NOWHERE) }),
            Content::Call(kind, result) => {
                block.calls.push((block.insts.len(), result));
                block.insts.push(Inst { kind, origin: CodeOrigin::of(NOWHERE) });
            }
            Content::Terminator(terminator) => {
                block.terminator = Some(terminator);
                self.open = None;
            }
        }
        Ok(())
    }

    /// A line that begins with `word:`: a block, a slot, the class of a value.
    fn declaration(&mut self, word: &str, line: &mut Cursor<'_>) -> LineResult<()> {
        if let Some(block) = number::<BlockId>(word, "block")? {
            if let Some(open) = self.open {
                return Err(format!("{open} does not end before this"));
            }
            if self.blocks.contains_key(&block) {
                return Err(format!("{block} appears twice"));
            }
            self.blocks.insert(block, BlockLines { begins: self.at, ..BlockLines::default() });
            self.function.layout.push(block);
            self.open = Some(block);
            return Ok(());
        }
        if !self.blocks.is_empty() {
            return Err(format!("`{word}` is declared after the first block"));
        }
        if let Some(slot) = number::<SlotId>(word, "slot")? {
            let size = line.count()?;
            line.expect("bytes")?;
            line.expect(",")?;
            line.expect("align")?;
            let next = self.function.slots.push(FrameSlot { size, align: line.count()? });
            return if next == slot { Ok(()) } else { Err(format!("{next} comes next, not {slot}")) };
        }
        match number::<ValueId>(word, "v")? {
            Some(value) => {
                self.record_mention(value);
                self.record_class(value, line.class()?)
            }
            None => Err(format!("`{word}` is not a block, slot or value")),
        }
    }

    /// Records the class of a value.
    pub(super) fn record_class(&mut self, value: ValueId, class: Class) -> LineResult<()> {
        self.classes
            .record(value, class)
            .map_err(|before| format!("{value} is {before} elsewhere, {class} here"))
    }

    /// Notes that this line names a value.
    pub(super) fn record_mention(&mut self, value: ValueId) {
        self.values.entry(value).or_insert(self.at);
    }

    /// Notes that this line jumps to a block.
    pub(super) fn target(&mut self, block: BlockId) {
        self.targets.entry(block).or_insert(self.at);
    }

    /// Records the class of an operand in this line.
    pub(super) fn check_class(&mut self, operand: Operand, class: Class) {
        self.compared.push((operand, class, self.at));
    }

    /// The whole function.
    pub(super) fn finish(mut self, signatures: &mut Signatures) -> Result<Function, ParseError> {
        self.check_blocks()?;
        self.fill_values()?;
        for &(operand, class, line) in &self.compared {
            let found = self.function.class(operand);
            if found != class {
                return Err(ParseError { line, message: format!("{operand:?} is {found}, not {class}") });
            }
        }
        let params = self.function.params.iter().map(|param| self.function.values[*param]).collect();
        self.function.signature = signatures.intern(&Signature { params, result: self.result });
        let numbers = self.fill_blocks(signatures);
        verify::verify(&self.function, signatures).map_err(|found| {
            let numbers = numbers.get(&found.block);
            let line = numbers.and_then(|numbers| numbers.get(found.index)).copied().unwrap_or(self.begins);
            ParseError { line, message: found.message }
        })?;
        Ok(self.function)
    }

    /// Every block ends, and every block that is jumped to exists.
    fn check_blocks(&self) -> Result<(), ParseError> {
        let error = |line, message| Err(ParseError { line, message });
        if self.blocks.is_empty() {
            return error(self.begins, "the function has no block".to_owned());
        }
        if let Some((id, block)) = self.blocks.iter().find(|(_, block)| block.terminator.is_none()) {
            return error(block.begins, format!("{id} does not end"));
        }
        match self.targets.iter().find(|(id, _)| !self.blocks.contains_key(id)) {
            Some((id, line)) => error(*line, format!("there is no {id}")),
            None => Ok(()),
        }
    }

    /// Gives every value its class; values that do not occur are ignored.
    fn fill_values(&mut self) -> Result<(), ParseError> {
        self.classes.propagate();
        let count = self.values.keys().next_back().map_or(0, |last| last.index() + 1);
        let mut values = PrimaryMap::with_capacity(count);
        for value in (0..count).map(ValueId::new) {
            let class = match (self.classes.get(value), self.values.get(&value)) {
                (Some(class), _) => class,
                (None, None) => Class::I32,
                (None, Some(line)) => {
                    let message =
                        format!("nothing says the class of {value}: declare it before the first block");
                    return Err(ParseError { line: *line, message });
                }
            };
            values.push(class);
        }
        self.function.values = values;
        Ok(())
    }

    /// Moves the blocks into the function; the lines of each.
    fn fill_blocks(&mut self, signatures: &mut Signatures) -> BTreeMap<BlockId, Vec<usize>> {
        let mut numbers = BTreeMap::new();
        let function = &mut self.function;
        for (id, mut block) in std::mem::take(&mut self.blocks) {
            for (place, result) in block.calls {
                if let InstKind::Call { arguments, signature, .. } = &mut block.insts[place].kind {
                    let classes = &function.arguments[arguments.range()];
                    let params = classes.iter().map(|argument| function.class(*argument)).collect();
                    *signature = signatures.intern(&Signature { params, result });
                }
            }
            // Numbers that the text does not use are blocks outside the layout.
            while function.blocks.len() <= id.index() {
                let (insts, terminator) = (Vec::new(), Terminator::Unreachable);
                function.blocks.push(Block { insts, terminator, origin: CodeOrigin::of(NOWHERE) });
            }
            let terminator = block.terminator.unwrap_or(Terminator::Unreachable);
            function.blocks[id] = Block { insts: block.insts, terminator, origin: CodeOrigin::of(NOWHERE) };
            numbers.insert(id, block.numbers);
        }
        numbers
    }
}
