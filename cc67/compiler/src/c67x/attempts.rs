//! Attempts at a function: the later stages in several variants, of which the best is kept.
//!
//! All attempts share one budget of work. It grows with the size of the function, so that the time for a program is
//! proportional to its length; beyond it, attempts search no further.

use super::allocate::{self, Assignment};
use super::code::Code;
use super::expand::{self, ReturnAddress, TooLarge};
use super::memo::Memo;
use super::modulo::WorkBudget;
use super::packets::ScheduledRegion;
use super::schedule::Order;
use super::sides::{self, Policy};
use super::{counters, late, pipeline, refine, unroll};
use crate::ir::function::Function;
use crate::passes::Level;

/// The most loops of a function that are tried in two ways.
const MOST_TRIED: u32 = 6;
/// The work for a function, and for each of its instructions.
const WORK: u32 = 1_200_000;
const WORK_PER_INST: u32 = 6_000;
/// The work that an attempt is, for each instruction of the function.
const ATTEMPT: u32 = 400;

/// A function in packets.
pub(super) struct Attempt {
    pub(super) regions: Vec<ScheduledRegion>,
    pub(super) code: Code,
    /// Bytes of its frame.
    pub(super) frame: u32,
}

impl Attempt {
    /// Its words.
    fn word_count(&self) -> u32 {
        self.regions.iter().fold(0, |at, region| refine::end_address(region, at))
    }

    /// Its cycles, with an estimate of the frequency of each region.
    fn cost(&self) -> f32 {
        self.regions.iter().map(|region| region.weight * region.cycles as f32).sum()
    }

    /// The cost of the code in loops.
    fn loop_cost(&self) -> f32 {
        let inside = self.regions.iter().filter(|region| region.weight > 1.0);
        inside.map(|region| region.weight * region.cycles as f32).sum()
    }
}

/// The packets of a function. At the level that makes code larger, short loops are tried with and without unrolling,
/// and all loops with other sides for their registers; the best variants are kept.
///
/// # Errors
/// The function is too large for the processor.
pub(super) fn best_attempt(ir: &Function, code: Code, level: Level) -> Result<Attempt, TooLarge> {
    let insts = code.blocks.iter().map(|block| block.insts.len()).sum::<usize>();
    let insts = u32::try_from(insts).unwrap_or(u32::MAX);
    let work = WorkBudget(WORK.saturating_add(insts.saturating_mul(WORK_PER_INST)));
    let mut attempts = Attempts { ir, level, memo: Memo::default(), work, insts };
    if level == Level::Fast { attempts.fastest(code) } else { attempts.smallest(code) }
}

/// The attempts at one function.
struct Attempts<'a> {
    ir: &'a Function,
    level: Level,
    memo: Memo,
    /// The work that is left for all attempts.
    work: WorkBudget,
    /// Number of instructions of the function.
    insts: u32,
}

/// A function with physical registers for its virtual registers.
#[derive(Clone)]
struct AllocatedFunction {
    code: Code,
    assignment: Assignment,
}

impl Attempts<'_> {
    /// The better of two ways to return.
    fn smallest(&mut self, code: Code) -> Result<Attempt, TooLarge> {
        let has_calls = !code.calls.is_empty();
        let assigned = self.assign(code, Policy::USUAL)?;
        let frame = self.schedule(assigned.clone(), ReturnAddress::Frame);
        if self.level == Level::None || !has_calls {
            return frame;
        }
        let register = self.schedule(assigned, ReturnAddress::Register)?;
        frame.map(|frame| if register.word_count() <= frame.word_count() { register } else { frame })
    }

    /// The fastest of some ways to unroll loops and to share registers between the sides.
    fn fastest(&mut self, code: Code) -> Result<Attempt, TooLarge> {
        let has_loop =
            (0..).zip(&code.blocks).any(|(own, block)| block.terminator.targets().any(|to| to == own));
        let (mut best, count) = self.with_unrolling(&code, 0, Policy::USUAL);
        let mut skipped = 0;
        for index in 0..count.min(MOST_TRIED) {
            if !self.may_continue() {
                return best;
            }
            let (other, _) = self.with_unrolling(&code, skipped | 1 << index, Policy::USUAL);
            if other.as_ref().is_ok_and(|other| best.as_ref().map_or(true, |best| other.cost() < best.cost()))
            {
                best = other;
                skipped |= 1 << index;
            }
        }
        for policy in Policy::OTHERS.into_iter().filter(|_| has_loop) {
            if !self.may_continue() {
                return best;
            }
            let (other, _) = self.with_unrolling(&code, skipped, policy);
            let costs = |attempt: &Attempt| (attempt.loop_cost(), attempt.cost());
            if other.as_ref().is_ok_and(|other| best.as_ref().map_or(true, |best| costs(other) < costs(best)))
            {
                best = other;
            }
        }
        best
    }

    /// Reports whether there is work left for one more attempt, and spends it.
    fn may_continue(&mut self) -> bool {
        self.work.spend(self.insts.saturating_mul(ATTEMPT) as usize).is_ok()
    }

    /// An attempt in which the loops with a bit in `skipped` are not unrolled; and how many loops could be.
    fn with_unrolling(
        &mut self,
        code: &Code,
        skipped: u32,
        policy: Policy,
    ) -> (Result<Attempt, TooLarge>, u32) {
        let mut code = code.clone();
        let count = unroll::run(&mut code, skipped);
        let attempt =
            self.assign(code, policy).and_then(|assigned| self.schedule(assigned, ReturnAddress::Register));
        (attempt, count)
    }

    /// Replaces virtual registers by those of the processor.
    fn assign(&self, mut code: Code, policy: Policy) -> Result<AllocatedFunction, TooLarge> {
        if self.level != Level::None {
            counters::run(&mut code);
        }
        sides::assign(&mut code, policy);
        let assignment = allocate::allocate(&mut code, self.level).ok_or(TooLarge::Code)?;
        Ok(AllocatedFunction { code, assignment })
    }

    /// Takes instructions over the registers of the processor through the stages that follow.
    fn schedule(&mut self, assigned: AllocatedFunction, back: ReturnAddress) -> Result<Attempt, TooLarge> {
        let AllocatedFunction { code, assignment } = assigned;
        let expanded = expand::expand(self.ir, &code, &assignment, back)?;
        let order = if self.level == Level::None { Order::Source } else { Order::Early };
        let mut regions = if self.level == Level::Fast {
            pipeline::schedule(expanded.regions, expanded.labels, &mut self.memo, &mut self.work)
        } else {
            let mut at = 0;
            let in_place = |region| {
                let scheduled = self.memo.entry(region).scheduled(order, at);
                at = refine::end_address(&scheduled, at);
                scheduled
            };
            expanded.regions.into_iter().map(in_place).collect()
        };
        late::run(&mut regions, &expanded.late);
        Ok(Attempt { regions, code, frame: expanded.frame })
    }
}
