//! Moves virtual registers to memory: a load before every read, a store after every write.
//!
//! A register whose only value is a constant is made again before every read instead.

use super::code::{Arg, Base, Code, Info, Inst, MemoryPlace, VReg, Value};
use super::forms::Kind;
use super::select::make;

/// Rewrites the code for the registers that moved.
pub(super) fn to_memory(code: &mut Code, moved: &[VReg]) {
    for reg in moved {
        let home = match code.regs[*reg].constant {
            Some(value) => Home::Constant(value),
            None => {
                let first = code.spills.next_multiple_of(2);
                code.spills = first + if code.regs[*reg].is_pair { 2 } else { 1 };
                Home::Memory(first)
            }
        };
        let mut mover = Mover { code, reg: *reg, home };
        mover.params();
        for block in 0..mover.code.blocks.len() {
            mover.block(block);
        }
    }
}

/// The most arguments that find room on any side: all are needed at once, and a side has eight pairs.
const CROWDED: usize = 6;

/// The source of a spilled register's value.
#[derive(Clone, Copy)]
enum Home {
    Memory(u32),
    Constant(Value),
}

struct Mover<'a> {
    code: &'a mut Code,
    reg: VReg,
    home: Home,
}

impl Mover<'_> {
    /// A register for one instruction in place of the one that moved.
    fn short(&mut self, is_pair: bool) -> VReg {
        let old = self.code.regs[self.reg];
        let is_condition = old.is_condition && !is_pair;
        self.code.reg(Info {
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

    /// A parameter is stored at once.
    fn params(&mut self) {
        let Some(index) = self.code.params.iter().position(|(reg, _)| *reg == self.reg) else { return };
        let short = self.short(self.is_pair());
        self.code.params[index].0 = short;
        self.code.regs[short].hint = Some(self.code.params[index].1);
        let span = self.code.blocks.first().map(|block| block.span);
        if let Some(span) = span {
            let mut stores = Vec::new();
            self.store(short, span, &mut stores);
            if let Some(first) = self.code.blocks.first_mut() {
                first.insts.splice(0..0, stores);
            }
        }
    }

    fn block(&mut self, number: usize) {
        let insts = std::mem::take(&mut self.code.blocks[number].insts);
        let mut out = Vec::with_capacity(insts.len() + 4);
        for inst in insts {
            self.inst(inst, &mut out);
        }
        if self.code.blocks[number].end.read() == Some(self.reg) {
            let span = self.code.blocks[number].span;
            let short = self.load(span, &mut out);
            if let Some(read) = self.code.blocks[number].end.read_mut() {
                *read = short;
            }
        }
        self.code.blocks[number].insts = out;
    }

    fn inst(&mut self, mut inst: Inst, out: &mut Vec<Inst>) {
        let reg = self.reg;
        let written = inst.written().filter(|(written, _)| *written == reg);
        if written.is_some() && (inst.kind == Kind::Begin || matches!(self.home, Home::Constant(_))) {
            return;
        }
        let mut is_read = false;
        inst.visit_reads(|read| is_read |= read == reg);
        self.call(&inst, out);
        // A half that is read comes as a word of its own.
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
        let steps = inst.stepped() == Some(reg);
        if !is_read && written.is_none() {
            out.push(inst);
            return;
        }
        let short = if whole || keeps { self.load(inst.span, out) } else { self.short(self.is_pair()) };
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
        let short = self.short(is_pair);
        match self.home {
            Home::Constant(value) => out.extend(make(short.into(), value, span)),
            Home::Memory(first) if is_pair => {
                let mut inst = Inst::new(Kind::LoadPair, short.into(), Arg::None, Arg::None, span);
                inst.place = Some(MemoryPlace::new(Base::Spill(first), 0));
                out.push(inst);
            }
            Home::Memory(first) => {
                let mut inst = Inst::new(Kind::LoadWord, short.into(), Arg::None, Arg::None, span);
                inst.place = Some(MemoryPlace::new(Base::Spill(first), 0));
                out.push(inst);
            }
        }
        short
    }

    fn load_word(&mut self, offset: i32, span: crate::source::Span, out: &mut Vec<Inst>) -> VReg {
        let short = self.short(false);
        if let Home::Memory(first) = self.home {
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
        if let Home::Memory(first) = self.home {
            let mut inst = Inst::new(Kind::StoreWord, Arg::None, Arg::None, arg, span);
            inst.place = Some(MemoryPlace::new(Base::Spill(first), offset));
            out.push(inst);
        }
    }
}
