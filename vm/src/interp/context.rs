//! A context: registers, call frames and the stack pointer of one thread.

use std::cell::Cell;

use kmotiondef::{CodeAddr, GuestAddr};

use super::jumps::{JumpPoint, Jumps};
use super::split::SegmentRest;
use crate::engine::{FrameView, Stack};
use crate::filter::AccessFilter;
use crate::operand::FuncRef;
use crate::program::{Program, body_of};
use crate::trap::TrapKind;
use crate::verify::MAX_PARAMETERS;

/// The registers that one call can name; an index of 16 bits is always inside.
///
/// They are cells, as the windows of a caller and of its callee overlap.
pub(super) type Window = [Cell<u64>; WINDOW];

/// The number of registers in a window; after those that can be named, there is room for those that are cleared along
/// with them.
const WINDOW: usize = (1 << 16) + BLOCK;

/// The number of registers that are cleared at once.
const BLOCK: usize = 8;

/// The limit of registers of all calls together; a stack full of calls of ordinary functions has far fewer.
const MAX_REGISTERS: usize = 1 << 24;

/// Stack bytes that each call takes besides its frame, as on the board.
const CALL_OVERHEAD: u32 = 16;

/// A call that waits for its callee.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// The instruction after the call.
    pc: usize,
    /// First register.
    base: usize,
    /// Number of registers.
    registers: u16,
    /// Distinguishes the call from others, once `setjmp` was called in it; otherwise 0.
    mark: u16,
    /// Address of the frame in guest memory.
    stack_pointer: u32,
}

/// The calls of a context, and where it is.
#[derive(Clone, Debug)]
pub(super) struct Calls {
    /// The calls around the current one, outermost first.
    frames: Vec<Frame>,
    /// The current call, except for its program counter, which is in `pc`.
    current: Frame,
    stack: Stack,
    lowest: u32,
    jumps: Jumps,
    /// The next instruction to execute, or the instruction that stopped the context.
    pub(super) pc: usize,
    /// Result of the last call, as a slot.
    pub(super) result: u64,
}

/// The facts about a function that a call of it needs.
#[derive(Clone, Copy)]
pub(super) struct FunctionHead {
    /// Number of registers that are parameters.
    pub(super) parameters: u16,
    /// Number of registers.
    pub(super) registers: u16,
    /// Units of 8 bytes of its frame.
    pub(super) frame: u16,
}

impl FunctionHead {
    /// The head of `function`.
    pub(super) fn of(program: &Program, function: FuncRef) -> Self {
        let (signature, registers, frame) = program.head_of(function);
        Self { parameters: program.signature(signature).params.len() as u16, registers, frame }
    }
}

/// The registers and the frame of a call.
struct CallStorage<'a> {
    /// The first register.
    base: usize,
    window: &'a Window,
    /// Address of the frame in guest memory.
    stack_pointer: u32,
}

impl Calls {
    /// Calls `function` from the instruction `pc`, if the stack, `registers` and the list of calls have room; returns
    /// its window then.
    #[inline(always)]
    pub(super) fn call<'a>(
        &mut self,
        function: FuncRef,
        head: FunctionHead,
        pc: usize,
        registers: &'a [Cell<u64>],
    ) -> Option<&'a Window> {
        if self.frames.len() == self.frames.capacity() {
            return None;
        }
        let room = self.room(head, registers)?;
        self.frames.push(Frame { pc: pc + 1, ..self.current });
        Some(self.begin(function, head, room))
    }

    /// The room for a call, whose registers begin after those of the current call; `None` if the stack or the registers
    /// are not sufficient.
    #[inline(always)]
    fn room<'a>(&self, head: FunctionHead, registers: &'a [Cell<u64>]) -> Option<CallStorage<'a>> {
        let base = self.current.base + usize::from(self.current.registers);
        let bytes = bytes_of(head.frame);
        if bytes > self.current.stack_pointer - self.stack.limit {
            return None;
        }
        let window = registers.get(base..)?.first_chunk()?;
        Some(CallStorage { base, window, stack_pointer: self.current.stack_pointer - bytes })
    }

    /// Begins a call of `function`; all its registers but the parameters are 0.
    #[inline(always)]
    fn begin<'a>(&mut self, function: FuncRef, head: FunctionHead, room: CallStorage<'a>) -> &'a Window {
        let CallStorage { base, window, stack_pointer } = room;
        let (parameters, count) = (usize::from(head.parameters), usize::from(head.registers));
        clear(&window[parameters..], count - parameters);
        self.lowest = self.lowest.min(stack_pointer);
        self.pc = body_of(function, head.registers);
        self.current = Frame { pc: self.pc, base, registers: head.registers, mark: 0, stack_pointer };
        window
    }

    /// Returns to the caller; yields the caller's window among `registers`, or `None` if there is no caller.
    #[inline(always)]
    pub(super) fn pop_call<'a>(&mut self, registers: &'a [Cell<u64>]) -> Option<&'a Window> {
        let caller = self.frames.pop()?;
        self.pc = caller.pc;
        self.current = caller;
        self.window(registers)
    }

    /// The registers of the current call and all those after them, among all `registers`.
    #[inline(always)]
    pub(super) fn window<'a>(&self, registers: &'a [Cell<u64>]) -> Option<&'a Window> {
        registers.get(self.current.base..)?.first_chunk()
    }

    /// The number of calls around the current one.
    pub(super) const fn depth(&self) -> usize {
        self.frames.len()
    }

    /// The index in the window at which the arguments of the next call begin.
    #[inline(always)]
    pub(super) const fn arguments_at(&self) -> u16 {
        self.current.registers
    }

    /// Address of the current call's frame in guest memory.
    #[inline(always)]
    pub(super) const fn frame_address(&self) -> u32 {
        self.current.stack_pointer
    }
}

/// The state of a context besides guest memory.
#[derive(Debug)]
pub(super) struct Context {
    /// The registers of all calls, with a whole window after the first register of the current one.
    registers: Vec<u64>,
    pub(super) calls: Calls,
    /// The entry function, until it has been entered.
    pub(super) pending: Option<FuncRef>,
    /// The segment that is executed in steps, if the slice ends or has ended in one.
    pub(super) split: Option<SegmentRest>,
    /// The accesses of the slice that are not reported again; `None` if all accesses are reported, or none.
    pub(super) filter: Option<Box<AccessFilter>>,
}

/// A context as it was at an instant.
#[derive(Debug)]
pub(super) struct SavedContext {
    /// The registers of the calls in progress, and the arguments after them; the words after them are written before
    /// they are read.
    registers: Vec<u64>,
    calls: Calls,
    pending: Option<FuncRef>,
    split: Option<SegmentRest>,
    filter: Option<Box<AccessFilter>>,
}

impl Context {
    /// Returns a copy of the context.
    pub(super) fn save(&self) -> SavedContext {
        let live = self.calls.current.base + usize::from(self.calls.current.registers) + MAX_PARAMETERS;
        SavedContext {
            registers: self.registers[..live.min(self.registers.len())].to_vec(),
            calls: self.calls.clone(),
            pending: self.pending,
            split: self.split.clone(),
            filter: self.filter.clone(),
        }
    }

    /// Restores the context from a copy.
    pub(super) fn put_back(&mut self, saved: &SavedContext) {
        let SavedContext { registers, calls, pending, split, filter } = saved;
        if self.registers.len() < registers.len() + WINDOW {
            self.registers.resize(registers.len() + WINDOW, 0);
        }
        self.registers[..registers.len()].copy_from_slice(registers);
        self.calls.clone_from(calls);
        self.pending = *pending;
        self.split.clone_from(split);
        self.filter.clone_from(filter);
    }

    pub(super) fn new() -> Self {
        Self {
            registers: vec![0; WINDOW],
            calls: Calls {
                frames: Vec::new(),
                current: Frame { pc: 0, base: 0, registers: 0, mark: 0, stack_pointer: 0 },
                stack: Stack { limit: 0, top: 0 },
                lowest: 0,
                jumps: Jumps::default(),
                pc: 0,
                result: 0,
            },
            pending: None,
            split: None,
            filter: None,
        }
    }

    /// Clears the context; the next step enters `function`.
    pub(super) fn reset(&mut self, function: FuncRef, stack: Stack) {
        let calls = &mut self.calls;
        calls.frames.clear();
        calls.current = Frame { pc: 0, base: 0, registers: 0, mark: 0, stack_pointer: stack.top };
        calls.stack = stack;
        calls.lowest = stack.top;
        calls.jumps.clear();
        calls.pc = function.0 as usize;
        calls.result = 0;
        self.pending = Some(function);
        self.split = None;
        if let Some(filter) = &self.filter {
            filter.clear();
        }
    }

    /// Begins the outermost call; its parameters are 0.
    pub(super) fn enter(&mut self, program: &Program, function: FuncRef) -> Result<(), TrapKind> {
        self.registers[..MAX_PARAMETERS].fill(0);
        self.make_room(program, function)?;
        let (calls, registers) = self.parts();
        let head = FunctionHead::of(program, function);
        let room = calls.room(head, registers).expect("there is room");
        calls.begin(function, head, room);
        Ok(())
    }

    /// Calls `function` with the arguments in the slots after the current registers.
    pub(super) fn call(&mut self, program: &Program, function: FuncRef) -> Result<(), TrapKind> {
        self.make_room(program, function)?;
        let (calls, registers) = self.parts();
        let pc = calls.pc;
        calls.call(function, FunctionHead::of(program, function), pc, registers).expect("there is room");
        Ok(())
    }

    /// Makes room for the registers of a call of `function`, if the stack has room for its frame.
    fn make_room(&mut self, program: &Program, function: FuncRef) -> Result<(), TrapKind> {
        let Calls { current, stack, .. } = &self.calls;
        let bytes = bytes_of(program.head_of(function).2);
        let base = current.base + usize::from(current.registers);
        if bytes > current.stack_pointer - stack.limit || base > MAX_REGISTERS {
            let used = stack.top - current.stack_pointer + bytes;
            return Err(TrapKind::StackOverflow { used, size: stack.size() });
        }
        if self.registers.len() < base + WINDOW {
            self.registers.resize(2 * base + WINDOW, 0);
        }
        self.calls.frames.reserve(1);
        Ok(())
    }

    /// Returns the calls, their registers, and the access filter, to execute instructions with them.
    pub(super) fn execution(&mut self) -> (&mut Calls, &[Cell<u64>], Option<&AccessFilter>) {
        let registers = Cell::from_mut(&mut self.registers[..]).as_slice_of_cells();
        (&mut self.calls, registers, self.filter.as_deref())
    }

    /// Returns the calls and their registers.
    pub(super) fn parts(&mut self) -> (&mut Calls, &[Cell<u64>]) {
        (&mut self.calls, Cell::from_mut(&mut self.registers[..]).as_slice_of_cells())
    }

    /// A register of the current call.
    pub(super) fn get(&self, register: u16) -> u64 {
        self.registers[self.calls.current.base + usize::from(register)]
    }

    /// Sets a register of the current call.
    pub(super) fn set(&mut self, register: u16, slot: u64) {
        self.registers[self.calls.current.base + usize::from(register)] = slot;
    }

    /// Saves a jump point after the current instruction, a call of `setjmp` that fills `place`; returns the number of
    /// the jump point.
    ///
    /// # Errors
    /// [`TrapKind::TooManyJumpPlaces`]
    pub(super) fn set_jump(&mut self, place: GuestAddr) -> Result<u32, TrapKind> {
        let Calls { frames, current, jumps, pc, .. } = &mut self.calls;
        let depth = frames.len();
        jumps.retain(|point| {
            let frame = if point.depth == depth { Some(&*current) } else { frames.get(point.depth) };
            frame.is_some_and(|frame| frame.mark == point.mark)
        });
        if current.mark == 0 {
            current.mark = jumps.free_mark();
        }
        let registers = &self.registers[current.base..current.base + usize::from(current.registers)];
        let point = JumpPoint { place, mark: current.mark, depth, pc: *pc + 1, registers: registers.into() };
        jumps.keep(point)
    }

    /// Continues at the jump point with this number, in the call that it belongs to; returns whether that call is still
    /// active.
    #[must_use]
    pub(super) fn long_jump(&mut self, number: u32) -> bool {
        let Calls { frames, current, jumps, pc, .. } = &mut self.calls;
        let Some(point) = jumps.find(number) else { return false };
        if point.depth < frames.len() {
            if frames[point.depth].mark != point.mark {
                return false;
            }
            *current = frames[point.depth];
            frames.truncate(point.depth);
        } else if point.depth > frames.len() || current.mark != point.mark {
            return false;
        }
        *pc = point.pc;
        self.registers[current.base..current.base + point.registers.len()].copy_from_slice(&point.registers);
        true
    }

    /// The calls in progress, innermost first.
    pub(super) fn frames(&self, address_of: impl Fn(usize) -> CodeAddr) -> Vec<FrameView> {
        if self.pending.is_some() {
            return Vec::new();
        }
        let callers = self.calls.frames.iter().rev().map(|frame| (frame.pc - 1, frame, true));
        let all = std::iter::once((self.calls.pc, &self.calls.current, false)).chain(callers);
        let view = |(pc, frame, is_caller): (usize, &Frame, bool)| FrameView {
            at: address_of(pc),
            continues_at: address_of(if is_caller { pc + 1 } else { pc }),
            frame: GuestAddr::new(frame.stack_pointer),
            registers: self.registers[frame.base..frame.base + usize::from(frame.registers)].to_vec(),
        };
        all.map(view).collect()
    }

    /// Sets a register of the call `frame`, counted from the innermost; returns whether there is such a register.
    pub(super) fn set_in(&mut self, frame: usize, register: u16, slot: u64) -> bool {
        let Calls { frames, current, .. } = &self.calls;
        let frame = if frame == 0 { Some(current) } else { frames.iter().rev().nth(frame - 1) };
        let Some(frame) = frame.filter(|frame| register < frame.registers) else { return false };
        self.registers[frame.base + usize::from(register)] = slot;
        true
    }

    /// The arguments of the next call.
    pub(super) fn arguments(&self, count: usize) -> &[u64] {
        let first = self.calls.current.base + usize::from(self.calls.current.registers);
        &self.registers[first..first + count]
    }

    /// The most bytes of the stack in use since the reset.
    pub(super) const fn stack_used(&self) -> u32 {
        self.calls.stack.top - self.calls.lowest
    }

    /// The current instruction and the calls that led to it, innermost first.
    pub(super) fn backtrace(&self) -> Vec<usize> {
        let callers = self.calls.frames.iter().rev().map(|frame| frame.pc - 1);
        std::iter::once(self.calls.pc).chain(callers).collect()
    }
}

/// Sets the first `count` of `registers` to 0, and some after them, which are not read before they are set.
#[inline(always)]
fn clear(registers: &[Cell<u64>], count: usize) {
    for block in registers.as_chunks::<BLOCK>().0.iter().take(count.div_ceil(BLOCK)) {
        for register in block {
            register.set(0);
        }
    }
}

/// Stack bytes taken by a call whose frame has `frame` units.
fn bytes_of(frame: u16) -> u32 {
    u32::from(frame) * 8 + CALL_OVERHEAD
}
