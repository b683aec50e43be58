//! Conditional execution in place of short branches, and merging of consecutive blocks.
//!
//! A branch costs six cycles and ends a region; an instruction whose condition is false has no effect. If a short block
//! only continues at the target of the branch around it, its instructions are moved before the branch, under its
//! condition. Instructions without effect whose results are not used elsewhere become unconditional; loads and stores
//! never do.

use cranelift_entity::SecondaryMap;

use super::code::{Block, Code, Condition, Inst, Terminator, VReg};
use super::forms::Kind;

/// The most instructions of a block that moves under a condition.
const SHORT: usize = 10;
/// The most instructions of a block that another joins.
const LONG: usize = 400;
/// The most rounds over all blocks.
const ROUNDS: usize = 6;

/// Rewrites the blocks.
pub(super) fn run(code: &mut Code) {
    for _ in 0..ROUNDS {
        let mut worker = Worker { before: predecessors(code), home: find_user_blocks(code), code };
        let mut is_changed = false;
        for block in 0..worker.code.blocks.len() {
            while worker.join(block) {
                is_changed = true;
            }
            is_changed |= worker.convert(block);
        }
        if !is_changed {
            break;
        }
        compact(code);
    }
}

/// Number of predecessors of each block.
fn predecessors(code: &Code) -> Vec<u32> {
    let mut before = vec![0; code.blocks.len()];
    if let Some(first) = before.first_mut() {
        *first = 1;
    }
    for target in code.blocks.iter().flat_map(|block| block.terminator.targets()) {
        before[target as usize] += 1;
    }
    before
}

/// The blocks that use a register.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum UserBlocks {
    #[default]
    Nowhere,
    Block(u32),
    Several,
}

impl UserBlocks {
    /// Reports whether it is used by a block other than this one.
    pub(super) fn is_outside(self, block: u32) -> bool {
        match self {
            Self::Nowhere => false,
            Self::Block(own) => own != block,
            Self::Several => true,
        }
    }

    /// A block uses it.
    pub(super) fn add(&mut self, block: u32) {
        *self = match *self {
            Self::Nowhere => Self::Block(block),
            Self::Block(own) if own == block => *self,
            Self::Block(_) | Self::Several => Self::Several,
        };
    }
}

/// The blocks that use each register; a parameter is used outside all.
pub(super) fn find_user_blocks(code: &Code) -> SecondaryMap<VReg, UserBlocks> {
    let mut homes = SecondaryMap::with_capacity(code.regs.len());
    homes.resize(code.regs.len());
    for (reg, _) in &code.params {
        homes[*reg] = UserBlocks::Several;
    }
    for (number, block) in (0..).zip(&code.blocks) {
        let mut mention = |reg: VReg| homes[reg].add(number);
        for inst in &block.insts {
            inst.visit_reads(&mut mention);
            if let Some((reg, _)) = inst.written_register() {
                mention(reg);
            }
            if inst.kind == Kind::Call {
                code.calls[inst.number as usize].arguments.iter().for_each(|(reg, _)| mention(*reg));
            }
        }
        if let Some(reg) = block.terminator.read() {
            mention(reg);
        }
    }
    homes
}

struct Worker<'a> {
    code: &'a mut Code,
    before: Vec<u32>,
    home: SecondaryMap<VReg, UserBlocks>,
}

impl Worker<'_> {
    fn block(&self, number: u32) -> &Block {
        &self.code.blocks[number as usize]
    }

    /// Appends the block that follows, if no other path leads to it.
    fn join(&mut self, number: usize) -> bool {
        if self.before[number] == 0 {
            return false;
        }
        let Terminator::Jump(next) = self.code.blocks[number].terminator else { return false };
        let at = next as usize;
        let is_own = at != number && self.before[at] == 1 && at != 0;
        if !is_own || self.code.blocks[number].insts.len() + self.code.blocks[at].insts.len() > LONG {
            return false;
        }
        let insts = std::mem::take(&mut self.code.blocks[at].insts);
        let end = std::mem::replace(&mut self.code.blocks[at].terminator, Terminator::Unreachable);
        self.before[at] = 0;
        let (depth, span) = (self.code.blocks[at].depth, self.code.blocks[at].span);
        for inst in &insts {
            self.move_home(inst, next, number as u32);
        }
        if let Some(reg) = end.read() {
            self.move_use(reg, next, number as u32);
        }
        let block = &mut self.code.blocks[number];
        block.insts.extend(insts);
        block.terminator = end;
        block.depth = block.depth.min(depth);
        block.span = span;
        true
    }

    fn move_use(&mut self, reg: VReg, from: u32, to: u32) {
        if self.home[reg] == UserBlocks::Block(from) {
            self.home[reg] = UserBlocks::Block(to);
        }
    }

    fn move_home(&mut self, inst: &Inst, from: u32, to: u32) {
        let mut regs = Vec::new();
        inst.visit_reads(|reg| regs.push(reg));
        regs.extend(inst.written_register().map(|(reg, _)| reg));
        if inst.kind == Kind::Call {
            regs.extend(self.code.calls[inst.number as usize].arguments.iter().map(|(reg, _)| *reg));
        }
        for reg in regs {
            self.move_use(reg, from, to);
        }
    }

    /// Puts one or both of the blocks after a branch under its condition.
    fn convert(&mut self, number: usize) -> bool {
        let Terminator::Branch { condition, negated, then, otherwise } = self.code.blocks[number].terminator
        else {
            return false;
        };
        if self.before[number] == 0 || self.code.blocks[number].insts.len() > LONG {
            return false;
        }
        let after = |worker: &Self, block: u32| match worker.block(block).terminator {
            Terminator::Jump(to) if worker.is_short(block, number, condition) => Some(to),
            _ => None,
        };
        let (yes, no) = (after(self, then), after(self, otherwise));
        let (sides, end): (&[(u32, bool)], u32) = if yes == Some(otherwise) {
            (&[(then, negated)], otherwise)
        } else if no == Some(then) {
            (&[(otherwise, !negated)], then)
        } else if let (Some(yes), Some(no)) = (yes, no)
            && yes == no
            && self.block(then).insts.len() + self.block(otherwise).insts.len() <= SHORT
        {
            (&[(then, negated), (otherwise, !negated)], yes)
        } else {
            return false;
        };
        for (block, negated) in sides.iter().copied() {
            self.predicate_block(number, block, Some((condition, negated)));
        }
        self.before[end as usize] -= 1;
        self.code.blocks[number].terminator = Terminator::Jump(end);
        true
    }

    /// Reports whether a block can be executed under the condition of the block before it.
    fn is_short(&self, block: u32, from: usize, condition: VReg) -> bool {
        let own = self.block(block);
        block as usize != from
            && block != 0
            && self.before[block as usize] == 1
            && own.insts.len() <= SHORT
            && own.insts.iter().all(|inst| {
                inst.condition.is_none()
                    && !matches!(inst.kind, Kind::Call | Kind::FrameAddress)
                    && inst.written_register().is_none_or(|(reg, _)| reg != condition)
                    && inst.incremented_base().is_none()
            })
    }

    fn predicate_block(&mut self, number: usize, block: u32, condition: Condition) {
        let insts = std::mem::take(&mut self.code.blocks[block as usize].insts);
        self.code.blocks[block as usize].terminator = Terminator::Unreachable;
        self.before[block as usize] = 0;
        for inst in insts {
            self.predicate_inst(number, block, inst, condition);
        }
        if let Some((reg, _)) = condition {
            self.home[reg] = UserBlocks::Several;
        }
    }

    fn predicate_inst(&mut self, number: usize, block: u32, mut inst: Inst, condition: Condition) {
        let is_own =
            inst.written_register().is_some_and(|(reg, _)| self.home[reg] == UserBlocks::Block(block));
        let is_memory = inst.kind.bytes().is_some();
        let reg = inst.written_register().map(|(reg, _)| reg);
        self.move_home(&inst, block, number as u32);
        let out = &mut self.code.blocks[number].insts;
        if is_own && !is_memory {
            out.push(inst);
            return;
        }
        if inst.kind == Kind::Begin {
            // If the condition fails, the halves that follow leave the old ones unchanged.
            return;
        }
        if let Some(reg) = reg.filter(|_| is_own && matches!(inst.dst, super::code::Arg::Reg(_))) {
            // If the condition fails, the result is not read, so the old value need not be kept.
            out.push(Inst::new(
                Kind::Begin,
                reg.into(),
                super::code::Arg::None,
                super::code::Arg::None,
                inst.span,
            ));
        }
        inst.condition = condition;
        out.push(inst);
    }
}

/// Drops unreachable blocks, and renumbers the others.
fn compact(code: &mut Code) {
    let mut reached = vec![false; code.blocks.len()];
    let mut open = vec![0_u32];
    while let Some(number) = open.pop() {
        if let Some(block) = code.blocks.get(number as usize)
            && !std::mem::replace(&mut reached[number as usize], true)
        {
            open.extend(block.terminator.targets());
        }
    }
    let mut numbers = vec![0_u32; code.blocks.len()];
    let mut next = 0;
    for (number, is_reached) in reached.iter().enumerate() {
        numbers[number] = next;
        next += u32::from(*is_reached);
    }
    let last = u32::from(next > 0);
    numbers.iter_mut().for_each(|number| *number = (*number).min(next - last));
    let mut keep = reached.into_iter();
    code.blocks.retain(|_| keep.next().unwrap_or(false));
    let renumber = |to: &mut u32| *to = numbers[*to as usize];
    for block in &mut code.blocks {
        match &mut block.terminator {
            Terminator::Jump(to) => renumber(to),
            Terminator::Branch { then, otherwise, .. } => {
                renumber(then);
                renumber(otherwise);
            }
            Terminator::Table { targets, .. } => targets.iter_mut().for_each(renumber),
            Terminator::Return(_) | Terminator::Unreachable => {}
        }
    }
    code.tables.iter_mut().flatten().for_each(renumber);
}
