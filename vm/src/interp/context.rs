//! A context: registers, call frames and the stack pointer of one thread.

use crate::engine::Stack;
use crate::operand::FuncRef;
use crate::program::Program;
use crate::trap::TrapKind;
use crate::verify::MAX_PARAMETERS;

/// The registers that one call can name; an index of 16 bits is always inside.
pub(super) type Window = [u64; WINDOW];

/// Number of registers in a window.
const WINDOW: usize = 1 << 16;

/// Most registers of all calls together; a stack full of calls of ordinary functions has far fewer.
const MAX_REGISTERS: usize = 1 << 24;

/// Bytes that each call takes of the stack besides its frame, as on the board.
const CALL_OVERHEAD: u32 = 16;

/// A call that waits for its callee.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// The instruction behind the call.
    pc: usize,
    /// First register.
    base: usize,
    /// Number of registers.
    registers: u16,
    /// Address of the frame in guest memory.
    stack_pointer: u32,
}

/// What a thread has besides guest memory.
#[derive(Debug)]
pub(super) struct Context {
    /// Of all calls, with a whole window behind the first register of the current one.
    registers: Vec<u64>,
    /// The calls around the current one, outermost first.
    frames: Vec<Frame>,
    /// The current call; its `pc` is kept in `pc`.
    current: Frame,
    stack: Stack,
    lowest: u32,
    /// The instruction to execute next, or the one that stopped the context.
    pub(super) pc: usize,
    /// Result of the last call, as a slot.
    pub(super) result: u64,
    /// The entry function, until it is entered.
    pub(super) pending: Option<FuncRef>,
}

impl Context {
    pub(super) fn new() -> Self {
        Self {
            registers: vec![0; WINDOW],
            frames: Vec::new(),
            current: Frame { pc: 0, base: 0, registers: 0, stack_pointer: 0 },
            stack: Stack { limit: 0, top: 0 },
            lowest: 0,
            pc: 0,
            result: 0,
            pending: None,
        }
    }

    /// Forgets everything; the next thing to do is entering `function`.
    pub(super) fn reset(&mut self, function: FuncRef, stack: Stack) {
        self.frames.clear();
        self.current = Frame { pc: 0, base: 0, registers: 0, stack_pointer: stack.top };
        self.stack = stack;
        self.lowest = stack.top;
        self.pc = function.0 as usize;
        self.result = 0;
        self.pending = Some(function);
    }

    /// Begins the outermost call; its parameters are 0.
    pub(super) fn enter(&mut self, program: &Program, function: FuncRef) -> Result<(), TrapKind> {
        self.registers[..MAX_PARAMETERS].fill(0);
        self.begin(program, function)
    }

    /// Calls `function` with the arguments that lie behind the current registers.
    pub(super) fn call(&mut self, program: &Program, function: FuncRef) -> Result<(), TrapKind> {
        let caller = Frame { pc: self.pc + 1, ..self.current };
        self.begin(program, function)?;
        self.frames.push(caller);
        Ok(())
    }

    fn begin(&mut self, program: &Program, function: FuncRef) -> Result<(), TrapKind> {
        let (signature, registers, frame) = program.head_of(function);
        let base = self.current.base + usize::from(self.current.registers);
        let bytes = u32::from(frame) * 8 + CALL_OVERHEAD;
        let room = self.current.stack_pointer - self.stack.limit;
        if bytes > room || base > MAX_REGISTERS {
            let used = self.stack.top - self.current.stack_pointer + bytes;
            return Err(TrapKind::StackOverflow { used, size: self.stack.size() });
        }
        if self.registers.len() < base + WINDOW {
            self.registers.resize(2 * base + WINDOW, 0);
        }
        let parameters = program.signature(signature).params.len();
        self.registers[base + parameters..base + usize::from(registers)].fill(0);
        let stack_pointer = self.current.stack_pointer - bytes;
        self.lowest = self.lowest.min(stack_pointer);
        self.current = Frame { pc: 0, base, registers, stack_pointer };
        self.pc = function.0 as usize + 1 + usize::from(registers).div_ceil(16);
        Ok(())
    }

    /// Goes back to the caller; false if there is none.
    pub(super) fn leave(&mut self) -> bool {
        let Some(caller) = self.frames.pop() else {
            return false;
        };
        self.pc = caller.pc;
        self.current = caller;
        true
    }

    /// The registers of the current call and what lies behind them.
    pub(super) fn window(&mut self) -> &mut Window {
        self.registers[self.current.base..].first_chunk_mut().expect("a call begins only where a window fits")
    }

    /// Where the arguments of the next call begin in the window.
    pub(super) const fn arguments_at(&self) -> u16 {
        self.current.registers
    }

    /// The arguments of the next call.
    pub(super) fn arguments(&self, count: usize) -> &[u64] {
        let first = self.current.base + usize::from(self.current.registers);
        &self.registers[first..first + count]
    }

    /// Address of the current call's frame in guest memory.
    pub(super) const fn frame_address(&self) -> u32 {
        self.current.stack_pointer
    }

    /// The most bytes of the stack in use since the reset.
    pub(super) const fn stack_used(&self) -> u32 {
        self.stack.top - self.lowest
    }

    /// The current instruction and the calls that led there, innermost first.
    pub(super) fn calls(&self) -> Vec<usize> {
        let callers = self.frames.iter().rev().map(|frame| frame.pc - 1);
        std::iter::once(self.pc).chain(callers).collect()
    }
}
