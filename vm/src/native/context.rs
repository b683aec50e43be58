//! A context of the native engine: its fiber, its position, and the data to continue.

use std::sync::Arc;

use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use super::fiber::{Answer, Fiber, SavedFiber};
use super::protected::ProtectedBlocks;
use super::request::{Reason, Request};
use super::state::BYTES_PER_CALL;
use crate::access::HighWord;
use crate::call::ArgumentList;
use crate::engine::{ContextId, Iteration, Slice, Stack, Stop};
use crate::filter::owner_code;
use crate::firmware::{Firmware, Outcome};
use crate::interp::observe::{AccessPart, CompletedAccess, Observer};
use crate::kind::OpKind;
use crate::operand::{FuncRef, SigRef};
use crate::polling::TimeTests;
use crate::program::Program;
use crate::slot::Slot;
use crate::trap::TrapKind;
use crate::wake::Wake;

/// The way in which a resumed context continues.
#[derive(Clone, Debug)]
enum Continuation {
    /// Continue with the answer to its last request.
    Answer(Answer),
    /// Continue with the answer to this request, which a long slice could not give.
    Request(Request),
    /// Continue with the rest of a store.
    HighWord(HighWord),
    /// Repeat the firmware call of this address and signature, for which it waits.
    CallFirmware(GuestAddr, SigRef),
    /// Do not continue: the context has stopped for good.
    Nothing(Stop),
}

/// The step after a request; small, because it is returned at every request.
enum NextStep {
    /// Continue at once.
    Go(Answer),
    /// Wait, then continue as stated in the context.
    Wait(Wake),
    /// Stop, then continue as stated in the context.
    Stop(Halt),
}

/// The reason why a context stopped that does not wait.
#[derive(Clone, Copy)]
enum Halt {
    Preempted,
    NeedsBoard,
    Ended,
}

impl From<Halt> for Stop {
    fn from(halt: Halt) -> Self {
        match halt {
            Halt::Preempted => Self::Preempted,
            Halt::NeedsBoard => Self::NeedsBoard,
            Halt::Ended => Self::Ended,
        }
    }
}

/// The firmware calls that were found to match the called function's signature, enough for the calls of a loop.
#[derive(Clone, Copy, Debug, Default)]
struct CheckedCalls([Option<(GuestAddr, SigRef)>; 8]);

impl CheckedCalls {
    /// The place of a call among them.
    fn place(&mut self, address: GuestAddr, signature: SigRef) -> &mut Option<(GuestAddr, SigRef)> {
        // Functions of the firmware begin at multiples of 32 bytes.
        let number = (address.get() >> 5) as usize + usize::from(signature.0);
        &mut self.0[number % self.0.len()]
    }
}

/// A context.
#[derive(Debug)]
pub(super) struct Context {
    fiber: Fiber,
    program: Arc<Program>,
    stack: Stack,
    /// The next instruction to execute, or the instruction that stopped the context.
    at: usize,
    /// Address of the current call's frame; the top of the stack outside all calls.
    stack_pointer: u32,
    next: Continuation,
    /// The generation of the protected ranges for which the state's windows were computed.
    protected: Option<u64>,
    /// The arguments of the firmware call in progress.
    arguments: ArgumentList,
    checked: CheckedCalls,
}

/// A context as it was at an instant.
#[derive(Debug)]
pub(super) struct SavedContext {
    fiber: SavedFiber,
    program: Arc<Program>,
    stack: Stack,
    at: usize,
    stack_pointer: u32,
    next: Continuation,
}

impl SavedContext {
    /// The context. Only one may exist at a time.
    pub(super) fn context(&self) -> Context {
        let Self { fiber, program, stack, at, stack_pointer, next } = self;
        Context {
            fiber: fiber.fiber(),
            program: Arc::clone(program),
            stack: *stack,
            at: *at,
            stack_pointer: *stack_pointer,
            next: next.clone(),
            protected: None,
            arguments: ArgumentList::default(),
            checked: CheckedCalls::default(),
        }
    }
}

impl Context {
    /// Returns a copy of the context.
    pub(super) fn save(&self) -> SavedContext {
        SavedContext {
            fiber: self.fiber.save(),
            program: Arc::clone(&self.program),
            stack: self.stack,
            at: self.at,
            stack_pointer: self.stack_pointer,
            next: self.next.clone(),
        }
    }

    /// A context that has not begun; `fiber` will call `function` of `program`.
    pub(super) fn new(fiber: Fiber, program: Arc<Program>, function: FuncRef, stack: Stack) -> Self {
        Self {
            fiber,
            program,
            stack,
            at: function.0 as usize,
            stack_pointer: stack.top,
            next: Continuation::Answer(Answer::Slot(0)),
            protected: None,
            arguments: ArgumentList::default(),
            checked: CheckedCalls::default(),
        }
    }

    /// The fiber, so that its stack can be reused.
    pub(super) fn into_fiber(self) -> Fiber {
        self.fiber
    }

    /// The instruction at which the context is.
    pub(super) fn address(&self) -> CodeAddr {
        self.program.address_of(self.at)
    }

    /// The most bytes of the stack in use since the start.
    pub(super) fn stack_used(&self) -> u32 {
        self.fiber.state().stack_used()
    }

    /// The current instruction and the calls that led to it, innermost first.
    pub(super) fn backtrace(&self) -> Vec<CodeAddr> {
        let mut calls = vec![self.address()];
        let (mut at, mut frame) = (self.at, self.stack_pointer);
        while frame < self.stack.top
            && let Some(function) = self.program.function_around(at)
        {
            frame = frame.saturating_add(function.frame + BYTES_PER_CALL);
            if frame >= self.stack.top {
                break;
            }
            at = self.fiber.state().call_of(frame);
            calls.push(self.program.address_of(at));
        }
        calls
    }

    /// Ends the context: whenever it is resumed, it stops with `stop`.
    pub(super) fn end(&mut self, stop: Stop) -> Stop {
        self.next = Continuation::Nothing(stop.clone());
        stop
    }

    /// Runs the context until it stops; when it traps, `at` is the instruction that did it.
    pub(super) fn run<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        (protected, observer): (&mut ProtectedBlocks, &mut Option<Observer>),
    ) -> Result<Stop, TrapKind> {
        if let Some(observer) = observer {
            let state = self.fiber.state();
            state.filter.continues(slice.tick);
            state.signs.owner.set(owner_code(id).into());
            state.ram.owners.set(observer.owners().first());
        }
        let mut step = match &self.next {
            Continuation::Answer(answer) => NextStep::Go(*answer),
            Continuation::Request(request) => {
                let request = *request;
                self.answer(id, slice, request, observer.as_mut())?
            }
            Continuation::HighWord(word) => {
                slice.store_high_word(*word)?;
                NextStep::Go(Answer::Slot(0))
            }
            Continuation::CallFirmware(address, signature) => {
                let (address, signature) = (*address, *signature);
                self.call_firmware(id, slice, address, signature)?
            }
            Continuation::Nothing(stop) => return Ok(stop.clone()),
        };
        loop {
            let answer = match step {
                NextStep::Go(answer) => answer,
                NextStep::Wait(wake) => return Ok(Stop::Waiting(wake)),
                NextStep::Stop(halt) => return Ok(halt.into()),
            };
            let Some(request) = self.go_on(slice, protected, answer) else {
                self.at = self.fiber.state().returned_at.get() as usize;
                self.stack_pointer = self.stack.top;
                return Ok(self.end(Stop::Ended));
            };
            self.at = request.at as usize;
            self.stack_pointer = request.stack_pointer;
            step = self.answer(id, slice, request, observer.as_mut())?;
        }
    }

    /// Runs the fiber until its next request; `None` when the program has returned.
    fn go_on<F: Firmware + ?Sized>(
        &mut self,
        slice: &mut Slice<'_, F>,
        protected: &mut ProtectedBlocks,
        answer: Answer,
    ) -> Option<Request> {
        let state = self.fiber.state();
        state.budget.set(slice.budget.get());
        state.signs.is_long.set(slice.is_long.into());
        state.signs.tick.set(slice.tick.get());
        protected.follow(slice.memory.protected_texts());
        if self.protected != Some(protected.version()) {
            self.protected = Some(protected.version());
            state.set_windows(protected.windows(self.program.text().end.get()));
        }
        let request = self.fiber.resume(slice.memory, protected, answer);
        let state = self.fiber.state();
        slice.budget = Cycles::new(state.budget.get());
        if state.signs.touched.take() != 0 {
            slice.memory.mark_touched();
        }
        request
    }

    /// Stops the context, to continue later with `next`.
    fn halt(&mut self, halt: Halt, next: Continuation) -> NextStep {
        self.next = next;
        NextStep::Stop(halt)
    }

    /// Answers a request of compiled code.
    fn answer<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        request: Request,
        observer: Option<&mut Observer>,
    ) -> Result<NextStep, TrapKind> {
        let address = GuestAddr::new(request.a as u32);
        if slice.is_long && request.involves_board() {
            return Ok(self.halt(Halt::NeedsBoard, Continuation::Request(request)));
        }
        let slot = match request.reason().unwrap_or(Reason::Unreachable) {
            Reason::Preempted => return Ok(self.halt(Halt::Preempted, Continuation::Answer(Answer::Slot(0)))),
            Reason::Load => slice.load_slot(address, request.width().ok_or(TrapKind::Unreachable)?)?,
            Reason::Store => {
                slice.store_slot(address, request.width().ok_or(TrapKind::Unreachable)?, request.b)?;
                0
            }
            Reason::StoreLowWord => {
                let width = request.width().ok_or(TrapKind::Unreachable)?;
                let word = slice.store_low_word(address, width, request.b)?;
                self.report(id, slice, &request, observer);
                let Some(word) = word else { return Ok(NextStep::Go(Answer::Slot(0))) };
                return Ok(self.halt(Halt::Preempted, Continuation::HighWord(word)));
            }
            Reason::Accessed => {
                self.report(id, slice, &request, observer);
                0
            }
            Reason::Copy => {
                let from = GuestAddr::new((request.a >> 32) as u32);
                slice.memory.copy(address, from, request.b as u32)?;
                self.report(id, slice, &request, observer);
                0
            }
            Reason::Clear => {
                slice.memory.fill(address, 0, request.b as u32)?;
                self.report(id, slice, &request, observer);
                0
            }
            Reason::CallFirmware => return self.begin_firmware(id, slice, address, SigRef(request.b as u16)),
            Reason::CallPointer => {
                return resolve(&self.program, slice, address, SigRef(request.b as u16)).map(NextStep::Go);
            }
            Reason::PassIterations => {
                if request.b == slice.tick.get() {
                    self.pass_iterations(slice, request);
                }
                0
            }
            Reason::NeedsBoard => 0,
            Reason::StackOverflow => return Err(self.overflow(request)),
            Reason::DivisionByZero => {
                let op = request.division().ok_or(TrapKind::DivisionByZero)?;
                slice.memory.divided_by_zero(op, i32::from_slot(request.a))?.into_slot()
            }
            Reason::Unreachable => return Err(TrapKind::Unreachable),
        };
        Ok(NextStep::Go(Answer::Slot(slot)))
    }

    /// Reports the access of a request after it has been made.
    fn report<F: Firmware + ?Sized>(
        &self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        request: &Request,
        observer: Option<&mut Observer>,
    ) {
        let Some(observer) = observer else { return };
        let (address, source) = (request.a as u32, (request.a >> 32) as u32);
        let part = |address, size, is_store| AccessPart { address: GuestAddr::new(address), size, is_store };
        let is_store =
            self.program.ops().get(self.at).is_some_and(|op| matches!(op.kind(), OpKind::Store(_)));
        let (parts, value) = match (request.reason(), request.width()) {
            (Some(Reason::Copy), _) => (
                [Some(part(source, request.b as u32, false)), Some(part(address, request.b as u32, true))],
                0,
            ),
            (Some(Reason::Clear), _) => ([None, Some(part(address, request.b as u32, true))], 0),
            (_, Some(width)) => ([Some(part(address, width.bytes(), is_store)), None], request.b),
            (_, None) => return,
        };
        let filter = &self.fiber.state().filter;
        let is_known = parts[1].is_none() && filter.knows(self.at, address);
        for part in parts.into_iter().flatten().filter(|_| !is_known) {
            observer.report(
                id,
                &self.program,
                CompletedAccess { word: self.at, part, value },
                Some(filter),
                slice,
            );
        }
    }

    /// Passes over iterations of the waiting loop that has requested it.
    fn pass_iterations<F: Firmware + ?Sized>(&self, slice: &mut Slice<'_, F>, request: Request) {
        let polling = self.fiber.loops().iter().find(|polling| polling.branches.contains(&self.at));
        let clock = polling.and_then(|polling| polling.clock.as_ref());
        let registers = clock.map(TimeTests::registers).unwrap_or_default();
        let given = &self.fiber.state().exchange.arguments;
        let place = |register| 1 + registers.iter().take_while(|other| **other != register).count();
        slice.pass_iterations(&Iteration {
            start: Cycles::new(request.a.cast_signed()),
            clock,
            called: Cycles::new(given[0].get().cast_signed()),
            register: &|register| f64::from_slot(given[place(register)].get()),
        });
    }

    /// Handles a call for which the stack has no room; the trap is attributed to the caller.
    fn overflow(&mut self, request: Request) -> TrapKind {
        if request.stack_pointer < self.stack.top {
            self.at = self.fiber.state().call_of(request.stack_pointer);
        }
        let used = self.stack.top - request.stack_pointer + request.a as u32;
        TrapKind::StackOverflow { used, size: self.stack.size() }
    }

    /// Makes a firmware call for the first time.
    fn begin_firmware<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        address: GuestAddr,
        signature: SigRef,
    ) -> Result<NextStep, TrapKind> {
        let checked = self.checked.place(address, signature);
        if *checked != Some((address, signature)) {
            let Some(callee) = slice.firmware.signature(address) else {
                return Err(TrapKind::UnknownFirmwareFunction { addr: address });
            };
            callee.check_call(address, self.program.signature(signature))?;
            *checked = Some((address, signature));
        }
        self.call_firmware(id, slice, address, signature)
    }

    /// Makes the firmware call whose arguments are in the state.
    fn call_firmware<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        address: GuestAddr,
        signature: SigRef,
    ) -> Result<NextStep, TrapKind> {
        let given = &self.fiber.state().exchange.arguments;
        let parameters = &self.program.signature(signature).params;
        let arguments = self.arguments.gather(parameters, |position, _| given[position].get());
        let outcome = slice.call_firmware(id, address, arguments, self.program.address_of(self.at))?;
        if slice.firmware.take_ordering() {
            self.fiber.state().filter.clear();
        }
        Ok(match outcome {
            Outcome::Done(value) => NextStep::Go(Answer::Slot(value.into_slot())),
            Outcome::Wait(wake) => {
                self.next = Continuation::CallFirmware(address, signature);
                NextStep::Wait(wake)
            }
            Outcome::End => self.halt(Halt::Ended, Continuation::Nothing(Stop::Ended)),
        })
    }
}

/// The function that a call through the pointer `address` with `signature` calls.
fn resolve<F: Firmware + ?Sized>(
    program: &Program,
    slice: &Slice<'_, F>,
    address: GuestAddr,
    signature: SigRef,
) -> Result<Answer, TrapKind> {
    let stated = program.signature(signature);
    if let Some(function) = program.function_at(address) {
        program.signature_of(function).check_call(address, stated)?;
        let found = program.index_of(function);
        return found.map(Answer::Function).ok_or(TrapKind::BadCallTarget { addr: address });
    }
    let callee = slice.firmware.signature(address).ok_or(TrapKind::BadCallTarget { addr: address })?;
    callee.check_call(address, stated)?;
    Ok(Answer::Slot(0))
}
