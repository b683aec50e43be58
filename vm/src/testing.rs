//! Helpers that the tests of this crate share: a small firmware, and programs from text.

use kmotiondef::map::program_base;
use kmotiondef::{Cycles, GuestAddr, ThreadId, Ticks};

use crate::bus::Bus;
use crate::engine::Engine;
use crate::firmware::{Caller, Firmware, Outcome, Signature, TickContext, Value, Wake};
use crate::machine::{Config, Machine};
use crate::memory::GuestMemory;
use crate::operand::Class;
use crate::program::Program;
use crate::scheduler::SliceOwner;
use crate::text::assemble;
use crate::trap::{Trap, TrapKind};
use crate::verify::verify;
use kmotiondef::AccessSize;

/// Opens every test program: `sig0` is `()`, `sig1` `(i32)`, `sig2` `() -> i32`, `sig3` `(i32) -> i32`,
/// `sig4` `(i32, f64) -> f64`.
const HEAD: &str = "
program 1, 2
word 0x4004000000000000 ; 2.5
word 0x123456789abcdef0
sig 0, 0
sig 1, 0
types 0
sig 0, 1
sig 1, 1
types 0
sig 2, 4
types 0xc
";

/// First word after the head.
pub(crate) const HEAD_WORDS: usize = 11;

/// The address at which test programs store their results.
pub(crate) const OUT: GuestAddr = GuestAddr::new(0x1000_0000);

/// A call-back's address.
pub(crate) const CALLBACK: GuestAddr = GuestAddr::new(0x1000_0100);

pub(crate) fn thread(number: i32) -> ThreadId {
    ThreadId::new(number).expect("a number of 1 to 7")
}

/// The bytes of a program with these functions.
pub(crate) fn bytes(functions: &str) -> Vec<u8> {
    assemble(&format!("{HEAD}{functions}")).expect("the text is correct")
}

/// A program of thread `number`.
pub(crate) fn program(number: i32, functions: &str) -> Program {
    verify(&bytes(functions), program_base(thread(number))).expect("the program is correct")
}

/// The firmware functions, from address 0x1000_8000 on in steps of 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TestFunction {
    /// `void note(int)`: puts time, thread and value into the log.
    Note,
    /// `void delay(int cycles)`.
    Delay,
    /// `void next_slice(void)`.
    NextSlice,
    /// `int wait_for_flag(void)`: waits until the word after `OUT` is not 0 and returns it.
    WaitForFlag,
    /// `void done(void)`.
    Done,
    /// `void start(int)`.
    Start,
    /// `void pause(int)`.
    Pause,
    /// `int resume(int)`.
    Resume,
    /// `double scale(int, double)`: the product.
    Scale,
    /// Does not exist after its address.
    Missing,
}

impl TestFunction {
    fn at(address: GuestAddr) -> Option<Self> {
        use TestFunction::{Delay, Done, Missing, NextSlice, Note, Pause, Resume, Scale, Start, WaitForFlag};
        let all = [Note, Delay, NextSlice, WaitForFlag, Done, Start, Pause, Resume, Scale, Missing];
        let offset = address.get().wrapping_sub(0x1000_8000);
        (offset.is_multiple_of(8)).then(|| all.get(offset as usize / 8).copied()).flatten()
    }
}

/// A firmware with a few functions that records its calls.
#[derive(Clone, Debug)]
pub(crate) struct Fake {
    signatures: [Signature; 4],
    pub(crate) log: Vec<String>,
    pub(crate) ticks: u64,
    pub(crate) slices: String,
    pub(crate) bus: Vec<String>,
    pub(crate) skipped: u64,
}

impl Fake {
    pub(crate) fn new() -> Self {
        let signature = |params: &[Class], result| Signature { params: params.to_vec(), result };
        Self {
            signatures: [
                signature(&[], None),
                signature(&[Class::I32], None),
                signature(&[Class::I32], Some(Class::I32)),
                signature(&[Class::I32, Class::F64], Some(Class::F64)),
            ],
            log: Vec::new(),
            ticks: 0,
            slices: String::new(),
            bus: Vec::new(),
            skipped: 0,
        }
    }

    /// The results that must not depend on the way time passes: in single ticks or in many at once.
    pub(crate) fn seen(&self) -> (&[String], u64, &[String]) {
        (&self.log, self.ticks, &self.bus)
    }

    fn note(&mut self, now: Cycles, who: Option<ThreadId>, what: &str) {
        let who = who.map_or("-".to_owned(), |thread| thread.to_string());
        self.log.push(format!("{} {who} {what}", now.get()));
    }
}

impl Bus for Fake {
    fn read(&mut self, addr: GuestAddr, size: AccessSize, now: Cycles) -> u32 {
        self.bus.push(format!("{} read {} of {addr}", now.get(), size.bytes()));
        0x1234_5678
    }

    fn write(&mut self, addr: GuestAddr, size: AccessSize, value: u32, now: Cycles) {
        self.bus.push(format!("{} write {} of {addr}: {value:#x}", now.get(), size.bytes()));
    }

    fn access_cycles(&self, _: GuestAddr) -> Cycles {
        Cycles::new(40)
    }
}

impl Firmware for Fake {
    fn signature(&self, address: GuestAddr) -> Option<&Signature> {
        let [none, number, number_to_number, scale] = &self.signatures;
        TestFunction::at(address).map(|function| match function {
            TestFunction::Note | TestFunction::Delay | TestFunction::Start | TestFunction::Pause => number,
            TestFunction::Resume => number_to_number,
            TestFunction::Scale => scale,
            _ => none,
        })
    }

    fn call(&mut self, address: GuestAddr, caller: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind> {
        let argument = caller.arguments.get::<i32>(0);
        let target = ThreadId::new(argument);
        let unit = Outcome::Done(Value::Unit);
        Ok(match TestFunction::at(address).ok_or(TrapKind::UnknownFirmwareFunction { addr: address })? {
            TestFunction::Note => {
                self.note(caller.now(), caller.thread, &argument.to_string());
                unit
            }
            _ if caller.woken == Some(Wake::NextSlice) => unit,
            TestFunction::Delay => match caller.woken {
                Some(_) => unit,
                None => Outcome::Wait(Wake::At(caller.now() + Cycles::new(i64::from(argument)))),
            },
            TestFunction::NextSlice => Outcome::Wait(Wake::NextSlice),
            TestFunction::WaitForFlag => match caller.memory.peek::<i32>(OUT.offset(4)) {
                0 => Outcome::Wait(Wake::Retry),
                flag => Outcome::Done(Value::I32(flag)),
            },
            TestFunction::Done => Outcome::End,
            TestFunction::Start => {
                let _ = target.map(|thread| caller.threads.start(thread));
                unit
            }
            TestFunction::Pause => {
                let _ = target.map(|thread| caller.threads.pause(thread));
                unit
            }
            TestFunction::Resume => {
                let resumed = target.map(|thread| caller.threads.resume(thread));
                Outcome::Done(Value::I32(i32::from(!matches!(resumed, Some(Ok(()))))))
            }
            TestFunction::Scale => {
                Outcome::Done(Value::F64(f64::from(argument) * caller.arguments.get::<f64>(1)))
            }
            TestFunction::Missing => return Err(TrapKind::NotModelled { name: "Missing" }),
        })
    }

    fn callback(&self, memory: &GuestMemory) -> GuestAddr {
        GuestAddr::new(memory.peek(CALLBACK))
    }

    fn callback_returned(&mut self, context: &mut TickContext<'_>, spent: Cycles) {
        self.note(context.now, None, &format!("call-back spent {}", spent.get()));
    }

    fn tick(&mut self, _: &mut TickContext<'_>) {
        self.ticks += 1;
    }

    fn switch_to(&mut self, turn: SliceOwner, _: &mut TickContext<'_>) {
        self.slices.push(char::from(b'0' + turn.number()));
    }

    fn trapped(&mut self, trap: &Trap, context: &mut TickContext<'_>) {
        if trap.thread.is_none() {
            context.memory.poke(CALLBACK, 0_u32);
        }
        self.note(context.now, trap.thread, &trap.to_string());
    }

    fn stack_exceeded(&mut self, thread: ThreadId, used: u32) {
        self.log.push(format!("thread {thread} uses {used} bytes of stack"));
    }

    fn quiet_ticks(&self, _: &GuestMemory) -> u64 {
        u64::MAX
    }

    fn quiet_slices(&self, _: &GuestMemory) -> u64 {
        u64::MAX
    }

    fn skip_ticks(&mut self, count: u64, _: &mut TickContext<'_>) {
        self.ticks += count;
        self.skipped += count;
    }
}

/// A machine with `programs` loaded, each to start at its `main`, the first function; thread 1 is started.
pub(crate) fn machine(config: Config, programs: &[(i32, &str)]) -> Machine<Fake> {
    machine_on(config, programs)
}

/// A machine on the engine `E`.
pub(crate) fn machine_on<E: Engine>(config: Config, programs: &[(i32, &str)]) -> Machine<Fake, E> {
    let mut machine = Machine::new(Fake::new(), config);
    for (number, functions) in programs {
        let program = program(*number, functions);
        let entry = program.address_of(HEAD_WORDS).as_guest_addr();
        let base = program.base();
        machine.memory_mut().poke_bytes(base, &bytes(functions)).expect("the slot is mapped");
        machine.load_program(thread(*number), program, entry);
    }
    let _ = machine.start(thread(1));
    machine
}

/// Runs `programs` for `ticks` and yields the machine; the other engines must do the same.
pub(crate) fn run(programs: &[(i32, &str)], ticks: u64) -> Machine<Fake> {
    let mut machine = machine(Config::default(), programs);
    machine.run_until(Ticks::new(ticks));
    let mut profiled = machine_on::<crate::profile::ProfilingEngine>(Config::default(), programs);
    profiled.run_until(Ticks::new(ticks));
    assert_same(&machine, &profiled);
    #[cfg(feature = "native")]
    {
        let mut native = machine_on::<crate::native::NativeEngine>(Config::default(), programs);
        native.run_until(Ticks::new(ticks));
        assert_same(&machine, &native);
    }
    machine
}

/// Checks that no difference between two machines can be seen.
pub(crate) fn assert_same<A: Engine, B: Engine>(a: &Machine<Fake, A>, b: &Machine<Fake, B>) {
    assert_eq!(a.firmware().seen(), b.firmware().seen());
    assert_eq!(a.threads(), b.threads());
    for thread in ThreadId::all() {
        assert_eq!(a.backtrace(thread), b.backtrace(thread));
    }
    assert!(a.memory() == b.memory(), "memory differs");
}
