//! Threads on the processor: how they begin, call the firmware, lose the processor and end.
//!
//! A branch that leaves the program area is a call of the firmware: the function at that address is called with the
//! arguments of the calling convention, and the program continues at B3. Rules: `c67-subset.md` 5, 7 and 10 of the
//! specification.

use std::sync::Arc;

use c67x::Reg;
use c67x::convention::{ARGUMENTS, LINK, RESULT, STACK};
use kmotiondef::map::{BOARD_STACK_SIZE, BOARD_STACKS_BASE, KOGNA_STACKS_BASE};
use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId};

use super::account::{Account, Branch, is_return_of};
use super::core::{Core, Halt, HotCode};
use super::inspect::packet_text;
use super::view::View;
use crate::call::ArgumentList;
use crate::engine::{ContextId, Executor, ForeignSnapshot, ObservedAccesses, Preemption, Slice, Stack, Stop};
use crate::firmware::{ExecutedPacket, Firmware, Outcome, Value};
use crate::loaded::Image;
use crate::memory::GuestMemory;
use crate::operand::Class;
use crate::trap::{Trap, TrapKind};

const A5: Reg = Reg::a(5);
const A14: Reg = Reg::a(14);

/// The return address of a call-back: an address without code and without a function.
const CALLBACK_RETURN: u32 = 0xFFFF_FFE0;

/// The value put into registers that a firmware function may clobber, so that a later use of one is noticed.
const CHANGED: u32 = 0xC4A7_6ED0;

/// Runs real images.
#[derive(Debug, Default)]
pub struct DspEngine {
    contexts: [Option<Processor>; ContextId::COUNT],
    /// The translator of hot code, if translation is on.
    hot: Option<HotCode>,
    account: Option<Account>,
}

/// The contexts of a [`DspEngine`] as they were.
#[derive(Clone, Debug)]
pub struct DspSnapshot([Option<Processor>; ContextId::COUNT]);

#[derive(Clone, Debug)]
struct Processor {
    core: Core,
    /// B15 at the start.
    top: u32,
    arguments: ArgumentList,
    image: Arc<Image>,
}

impl DspEngine {
    /// An engine that translates hot code to host code if `hot` is given, and can keep an account.
    #[must_use]
    pub(crate) fn new(hot: Option<HotCode>, keeps_account: bool) -> Self {
        Self { hot, account: keeps_account.then(Account::default), ..Self::default() }
    }

    /// The time spent by place, if an account is kept.
    #[must_use]
    pub const fn account(&self) -> Option<&Account> {
        self.account.as_ref()
    }

    /// The registers and position of `id`; `None` if it was never started.
    #[must_use]
    pub fn core(&self, id: ContextId) -> Option<&Core> {
        self.contexts[id.index()].as_ref().map(|context| &context.core)
    }
}

/// B15 at the start of a thread, and the lowest address of its stack.
fn board_stack(image: &Image, thread: ThreadId) -> (u32, u32) {
    let stacks = if image.is_for_kogna() { KOGNA_STACKS_BASE } else { BOARD_STACKS_BASE };
    let base = stacks + BOARD_STACK_SIZE * (u32::from(thread.get()) - 1);
    // The start code reserves room for the registers that an interrupt saves, and frees it at once.
    let top = ((base + BOARD_STACK_SIZE - 140) & !7) + 128;
    (top, base)
}

impl Executor for DspEngine {
    type Code = Image;
    type Snapshot = DspSnapshot;

    /// The processor takes interrupts between two packets, regardless of the setting for bytecode.
    fn set_preemption(&mut self, _: Preemption) {}

    /// Accesses of code for the processor are not reported.
    fn observe(&mut self, _: ObservedAccesses) {}

    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        code: &Arc<Image>,
        entry: GuestAddr,
        stack: Stack,
        _firmware: &F,
    ) -> Result<(), TrapKind> {
        if !entry.get().is_multiple_of(4) || !Image::is_code(entry.get()) {
            return Err(TrapKind::BadCallTarget { addr: entry });
        }
        let mut core = Core::new(entry.get());
        let (top, base, returns_to) = match id.thread() {
            Some(thread) => {
                let (top, base) = board_stack(code, thread);
                core.state.set_reg(A14, u32::from(thread.get()));
                (top, base, code.returns_to().get())
            }
            None => (stack.top - 8, stack.limit, CALLBACK_RETURN),
        };
        core.state.set_reg(STACK, top);
        core.state.set_reg(LINK, returns_to);
        core.watch_stack(base, top);
        // Translated code has the addresses of a KFLOP's memory in it.
        core.translate_hot(self.hot.filter(|_| !code.is_for_kogna()));
        if let Some(account) = &mut self.account {
            account.begin(id);
        }
        let (arguments, image) = (ArgumentList::default(), Arc::clone(code));
        self.contexts[id.index()] = Some(Processor { core, top, arguments, image });
        Ok(())
    }

    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        let Some(context) = &mut self.contexts[id.index()] else { return Stop::Ended };
        let account = &mut self.account;
        if let Some(account) = account {
            account.resume(id, slice.now());
        }
        context.run(id, slice, account).unwrap_or_else(|kind| {
            let at = context.place();
            let memory = &*slice.memory;
            let word = |at| Image::is_code(at).then(|| memory.peek(GuestAddr::new(at)));
            let scene = context.core.scene(at.as_guest_addr().get(), word);
            Stop::Trapped(Trap { scene: Some(Box::new(scene)), ..Trap::new(kind, at, id.thread()) })
        })
    }

    fn snapshot(&self) -> DspSnapshot {
        DspSnapshot(self.contexts.clone())
    }

    fn restore(&mut self, snapshot: &DspSnapshot) -> Result<(), ForeignSnapshot> {
        // Memory is restored together with the contexts, so decoded packets match their words.
        self.contexts.clone_from(&snapshot.0);
        Ok(())
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        let Some(context) = &self.contexts[id.index()] else { return 0 };
        context.core.lowest_stack().map_or(0, |lowest| context.top.saturating_sub(lowest))
    }

    fn backtrace(&self, id: ContextId) -> Vec<CodeAddr> {
        self.contexts[id.index()].iter().map(Processor::place).collect()
    }
}

impl Processor {
    /// The packet about to be executed; in a firmware call, the branch that made it.
    fn place(&self) -> CodeAddr {
        let pc = self.core.state.pc();
        if Image::is_code(pc) { code_at(self.core.faulted_at().unwrap_or(pc)) } else { call_at(&self.core) }
    }

    fn run<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        account: &mut Option<Account>,
    ) -> Result<Stop, TrapKind> {
        loop {
            self.core.state.clock.set_left(slice.budget.get());
            let follows = slice.firmware.follows_packets(id.thread());
            let halt = if account.is_some() || follows {
                self.run_counted(id, slice, account, follows)
            } else {
                self.core.run(&mut View(slice))
            };
            slice.budget = Cycles::new(self.core.state.clock.left());
            match halt {
                // No thread has stops: they are of a board that runs a firmware.
                Halt::Preempted | Halt::Stopped => {
                    self.core.state.land_all();
                    return Ok(Stop::Preempted);
                }
                Halt::Left(CALLBACK_RETURN) if id == ContextId::CALLBACK => return Ok(Stop::Ended),
                Halt::Left(address) => {
                    let address = GuestAddr::new(address);
                    let (at, before) = (call_at(&self.core), slice.budget);
                    let stop = self.call(id, slice, address)?;
                    if let Some(account) = account {
                        let spender = (id, at, Some(address));
                        account.compute(spender, before - slice.budget);
                        if let Some(Stop::Waiting(_)) = stop {
                            account.wait(spender, slice.now());
                        }
                    }
                    if let Some(stop) = stop {
                        return Ok(stop);
                    }
                }
                Halt::Faulted(kind) => return Err(kind),
            }
        }
    }

    /// Executes packets one by one: for the account, and for observers.
    fn run_counted<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        account: &mut Option<Account>,
        follows: bool,
    ) -> Halt {
        let mut start = slice.now();
        let mut ran = Vec::new();
        let Self { core, image, .. } = self;
        let halt = core.run_counted(&mut View(slice), &mut |at, cycles, state| {
            let (at, cycles) = (code_at(at), Cycles::new(cycles));
            if let Some(account) = account {
                account.compute((id, at, None), cycles);
                let (next, from, link) = (state.pc(), state.branched_at()[0], state.reg(LINK));
                account.follow(
                    id,
                    next,
                    Branch { from: code_at(from), link, enters: image.begins_function(next) },
                );
            }
            if follows {
                ran.push((at, cycles));
            }
        });
        for (at, cycles) in ran {
            let word = |at| Image::is_code(at).then(|| slice.memory.peek(GuestAddr::new(at)));
            let text = packet_text(at.as_guest_addr().get(), word);
            slice.firmware.packet_ran(ExecutedPacket { thread: id.thread(), at, start, cycles, text });
            start += cycles;
        }
        halt
    }

    /// Makes the firmware call of an address; returns the stop if the program does not continue at once.
    fn call<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
        address: GuestAddr,
    ) -> Result<Option<Stop>, TrapKind> {
        self.core.state.land_all();
        let Self { core, arguments, .. } = self;
        let Some(signature) = slice.firmware.signature(address) else {
            return Err(TrapKind::BadCallTarget { addr: address });
        };
        let named = slice.firmware.is_variadic(address).then(|| signature.params.len() - 1);
        let memory = &*slice.memory;
        let at = call_at(core);
        let arguments = arguments.gather(&signature.params, |position, class| match named {
            Some(named) if position + 1 >= named => on_stack(core, memory, position + 1 - named),
            _ => in_register(core, position, class),
        });
        let outcome = slice.call_firmware(id, address, arguments, at)?;
        let changed = slice.firmware.changed_registers(address);
        match outcome {
            Outcome::Done(value) => {
                self.return_from(changed, value);
                Ok(None)
            }
            Outcome::Wait(wake) => Ok(Some(Stop::Waiting(wake))),
            Outcome::End => Ok(Some(Stop::Ended)),
        }
    }

    /// Continues after a firmware call.
    fn return_from(&mut self, changed: u64, value: Value) {
        let state = &mut self.core.state;
        let back = state.reg(LINK);
        let mut left = changed;
        while let Some(reg) = Reg::from_index(left.trailing_zeros() as usize) {
            state.set_reg(reg, CHANGED);
            left &= left - 1;
        }
        let slot = value.into_slot();
        match value.class() {
            None => {}
            Some(Class::I32 | Class::F32) => state.set_reg(RESULT, slot as u32),
            Some(Class::I64 | Class::F64) => {
                state.set_reg(RESULT, slot as u32);
                state.set_reg(A5, (slot >> 32) as u32);
            }
        }
        state.set_pc(back);
    }
}

/// The branch that made a firmware call; if the linker has inserted a jump, the branch to that jump.
fn call_at(core: &Core) -> CodeAddr {
    let [last, before] = core.state.branched_at();
    let back = core.state.reg(LINK);
    let is_call = |at: u32| is_return_of(back, at);
    code_at(if is_call(before) && !is_call(last) { before } else { last })
}

fn code_at(address: u32) -> CodeAddr {
    CodeAddr::new(address & !3).expect("it is made a multiple of 4")
}

/// An argument in registers; 0 after the tenth, which no firmware function has.
fn in_register(core: &Core, position: usize, class: Class) -> u64 {
    let Some(reg) = ARGUMENTS.get(position).copied() else { return 0 };
    let low = u64::from(core.state.reg(reg));
    match class {
        Class::I32 | Class::F32 => low,
        Class::I64 | Class::F64 => low | u64::from(core.state.reg(reg.pair().high())) << 32,
    }
}

/// The last named argument of a variadic function, or the address of the arguments after it.
fn on_stack(core: &Core, memory: &GuestMemory, after_named: usize) -> u64 {
    let first = core.state.reg(STACK).wrapping_add(4);
    let named = memory.peek::<u32>(GuestAddr::new(first));
    u64::from(if after_named == 0 { named } else { first.wrapping_add(4) })
}
