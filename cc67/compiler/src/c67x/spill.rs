//! Moves virtual registers to memory: a load before every read, a store after every write.
//!
//! A register whose only value is a constant is rematerialised before every read instead.

use cranelift_entity::SecondaryMap;

use super::code::{Arg, Base, Code, Inst, MemoryPlace, VReg, VRegInfo, Value};
use super::forms::Kind;
use super::select::make;

/// Rewrites the code for the registers that moved.
pub(super) fn to_memory(code: &mut Code, moved: &[VReg]) {
    let mut mentions = Mentions::new(code, moved);
    for (index, reg) in moved.iter().enumerate() {
        let home = match code.regs[*reg].constant {
            Some(value) => ReloadSource::Constant(value),
            None => {
                let first = code.spills.next_multiple_of(2);
                code.spills = first + if code.regs[*reg].is_pair { 2 } else { 1 };
                ReloadSource::Memory(first)
            }
        };
        let mut mover = Spiller { code, reg: *reg, source: home };
        mentions.first.splice(0..0, mover.params());
        for mention in std::mem::take(&mut mentions.of[index]) {
            mover.rewrite_mention(&mut mentions.all[mention as usize]);
        }
    }
    mentions.write(code);
}

/// The instructions that use spilled registers, taken out of the code, so that each register only visits its own.
struct Mentions {
    /// Instructions for the beginning of the function.
    first: Vec<Inst>,
    /// In the order of the code.
    all: Vec<Mention>,
    /// The numbers of the mentions that use each register that moves.
    of: Vec<Vec<u32>>,
}

/// An instruction with the code it needs before and after it, or the end of a block.
struct Mention {
    block: usize,
    /// The position in the block; `None` for its end.
    at: Option<usize>,
    insts: Vec<Inst>,
}

impl Mentions {
    fn new(code: &Code, moved: &[VReg]) -> Self {
        let mut number: SecondaryMap<VReg, Option<u32>> = SecondaryMap::with_capacity(code.regs.len());
        number.resize(code.regs.len());
        for (index, reg) in (0..).zip(moved) {
            number[*reg] = Some(index);
        }
        let mut mentions = Self { first: Vec::new(), all: Vec::new(), of: vec![Vec::new(); moved.len()] };
        let mut found: Vec<u32> = Vec::new();
        for (block, own) in code.blocks.iter().enumerate() {
            for (at, inst) in own.insts.iter().enumerate() {
                found.clear();
                inst.visit_reads(|reg| found.extend(number[reg]));
                found.extend(inst.written_register().and_then(|(reg, _)| number[reg]));
                found.extend(inst.incremented_base().and_then(|reg| number[reg]));
                if inst.kind == Kind::Call {
                    let arguments = &code.calls[inst.number as usize].arguments;
                    found.extend(arguments.iter().filter_map(|(reg, _)| number[*reg]));
                }
                mentions.add(&mut found, Mention { block, at: Some(at), insts: vec![*inst] });
            }
            found.clear();
            found.extend(own.terminator.read().and_then(|reg| number[reg]));
            mentions.add(&mut found, Mention { block, at: None, insts: Vec::new() });
        }
        mentions
    }

    /// Adds a mention if it uses some of the registers.
    fn add(&mut self, found: &mut Vec<u32>, mention: Mention) {
        found.sort_unstable();
        found.dedup();
        for index in &*found {
            self.of[*index as usize].push(self.all.len() as u32);
        }
        if !found.is_empty() {
            self.all.push(mention);
        }
    }

    /// Puts the instructions back into the code.
    fn write(self, code: &mut Code) {
        let mut mentions = self.all.into_iter().peekable();
        for (block, own) in code.blocks.iter_mut().enumerate() {
            let insts = std::mem::take(&mut own.insts);
            let mut out = Vec::with_capacity(insts.len() + 4);
            if block == 0 {
                out.extend(self.first.iter().copied());
            }
            let is_next = |mention: &Mention, at| mention.block == block && mention.at == at;
            for (at, inst) in insts.into_iter().enumerate() {
                match mentions.next_if(|mention| is_next(mention, Some(at))) {
                    Some(mention) => out.extend(mention.insts),
                    None => out.push(inst),
                }
            }
            out.extend(
                mentions
                    .next_if(|mention| is_next(mention, None))
                    .into_iter()
                    .flat_map(|mention| mention.insts),
            );
            own.insts = out;
        }
    }
}

/// The limit of arguments that fit on either side: all are needed at once, and a side has eight pairs.
const CROWDED: usize = 6;

/// The source of a spilled register's value.
#[derive(Clone, Copy)]
enum ReloadSource {
    Memory(u32),
    Constant(Value),
}

struct Spiller<'a> {
    code: &'a mut Code,
    reg: VReg,
    source: ReloadSource,
}

impl Spiller<'_> {
    /// A register for one instruction that replaces the spilled one.
    fn temporary_register(&mut self, is_pair: bool) -> VReg {
        let old = self.code.regs[self.reg];
        let is_condition = old.is_condition && !is_pair;
        self.code.reg(VRegInfo {
            is_pair,
            side: old.side,
            is_condition,
            is_short: true,
            hint: None,
            constant: None,
        })
    }

    fn is_pair(&self) -> bool {
        self.code.regs[self.reg].is_pair
    }

    /// Returns the stores of parameters at the beginning of the function.
    fn params(&mut self) -> Vec<Inst> {
        let mut stores = Vec::new();
        let Some(index) = self.code.params.iter().position(|(reg, _)| *reg == self.reg) else {
            return stores;
        };
        let short = self.temporary_register(self.is_pair());
        self.code.params[index].0 = short;
        self.code.regs[short].hint = Some(self.code.params[index].1);
        let span = self.code.blocks.first().map(|block| block.span);
        if let Some(span) = span {
            self.store(short, span, &mut stores);
        }
        stores
    }

    /// Rewrites an instruction that uses the register, or the end of a block.
    fn rewrite_mention(&mut self, mention: &mut Mention) {
        let mut out = Vec::with_capacity(mention.insts.len() + 2);
        for inst in std::mem::take(&mut mention.insts) {
            self.inst(inst, &mut out);
        }
        if mention.at.is_none() && self.code.blocks[mention.block].terminator.read() == Some(self.reg) {
            let span = self.code.blocks[mention.block].span;
            let short = self.load(span, &mut out);
            if let Some(read) = self.code.blocks[mention.block].terminator.read_mut() {
                *read = short;
            }
        }
        mention.insts = out;
    }

    fn inst(&mut self, mut inst: Inst, out: &mut Vec<Inst>) {
        let reg = self.reg;
        let written = inst.written_register().filter(|(written, _)| *written == reg);
        if written.is_some() && (inst.kind == Kind::Begin || matches!(self.source, ReloadSource::Constant(_)))
        {
            return;
        }
        let mut is_read = false;
        inst.visit_reads(|read| is_read |= read == reg);
        self.call(&inst, out);
        // A half that is read is reloaded as a separate word.
        for arg in [&mut inst.src1, &mut inst.src2] {
            let half = match *arg {
                Arg::Low(source) if source == reg => 0,
                Arg::High(source) if source == reg => 4,
                _ => continue,
            };
            *arg = Arg::Reg(self.load_word(half, inst.span, out));
        }
        let keeps = inst.keeps_destination() && written.is_some();
        let mut whole = false;
        inst.visit_reads(|read| whole |= read == reg);
        let steps = inst.incremented_base() == Some(reg);
        if !is_read && written.is_none() {
            out.push(inst);
            return;
        }
        let short =
            if whole || keeps { self.load(inst.span, out) } else { self.temporary_register(self.is_pair()) };
        let dst = inst.dst;
        if written.is_some() && !keeps && matches!(dst, Arg::Low(_) | Arg::High(_)) {
            out.push(Inst::new(Kind::Begin, short.into(), Arg::None, Arg::None, inst.span));
        }
        inst.visit_all(|own| {
            if *own == reg {
                *own = short;
            }
        });
        let span = inst.span;
        out.push(inst);
        match dst {
            Arg::Reg(own) if own == reg => self.store(short, span, out),
            Arg::Low(own) if own == reg => self.store_word(Arg::Low(short), 0, span, out),
            Arg::High(own) if own == reg => self.store_word(Arg::High(short), 4, span, out),
            _ if steps => self.store(short, span, out),
            _ => {}
        }
    }

    /// An argument of a call.
    fn call(&mut self, inst: &Inst, out: &mut Vec<Inst>) {
        if inst.kind != Kind::Call {
            return;
        }
        let number = inst.number as usize;
        for index in 0..self.code.calls[number].arguments.len() {
            let (argument, at) = self.code.calls[number].arguments[index];
            if argument == self.reg {
                let short = self.load(inst.span, out);
                let is_crowded = self.code.calls[number].arguments.len() > CROWDED;
                let info = &mut self.code.regs[short];
                info.hint = Some(at);
                if is_crowded {
                    info.side = Some(at.side());
                    info.is_condition = false;
                }
                self.code.calls[number].arguments[index].0 = short;
            }
        }
    }

    fn load(&mut self, span: crate::source::Span, out: &mut Vec<Inst>) -> VReg {
        let is_pair = self.is_pair();
        let short = self.temporary_register(is_pair);
        match self.source {
            ReloadSource::Constant(value) => out.extend(make(short.into(), value, span)),
            ReloadSource::Memory(first) if is_pair => {
                let mut inst = Inst::new(Kind::LoadPair, short.into(), Arg::None, Arg::None, span);
                inst.place = Some(MemoryPlace::new(Base::Spill(first), 0));
                out.push(inst);
            }
            ReloadSource::Memory(first) => {
                let mut inst = Inst::new(Kind::LoadWord, short.into(), Arg::None, Arg::None, span);
                inst.place = Some(MemoryPlace::new(Base::Spill(first), 0));
                out.push(inst);
            }
        }
        short
    }

    fn load_word(&mut self, offset: i32, span: crate::source::Span, out: &mut Vec<Inst>) -> VReg {
        let short = self.temporary_register(false);
        if let ReloadSource::Memory(first) = self.source {
            let mut inst = Inst::new(Kind::LoadWord, short.into(), Arg::None, Arg::None, span);
            inst.place = Some(MemoryPlace::new(Base::Spill(first), offset));
            out.push(inst);
        }
        short
    }

    fn store(&mut self, reg: VReg, span: crate::source::Span, out: &mut Vec<Inst>) {
        if self.is_pair() {
            self.store_word(Arg::Low(reg), 0, span, out);
            self.store_word(Arg::High(reg), 4, span, out);
        } else {
            self.store_word(Arg::Reg(reg), 0, span, out);
        }
    }

    fn store_word(&mut self, arg: Arg, offset: i32, span: crate::source::Span, out: &mut Vec<Inst>) {
        if let ReloadSource::Memory(first) = self.source {
            let mut inst = Inst::new(Kind::StoreWord, Arg::None, Arg::None, arg, span);
            inst.place = Some(MemoryPlace::new(Base::Spill(first), offset));
            out.push(inst);
        }
    }
}
