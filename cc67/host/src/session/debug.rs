//! Access for debuggers: holding a context between two instructions, and the calls in progress.

use kmotiondef::{CodeAddr, Cycles, GuestAddr};
use runtime::trace::Item;
use vm::engine::{AccessRange, CallEnd, ContextId, FrameView, Hold};

use super::{Session, UserProgram};
use crate::HostError;
use crate::capability::Capability;
use crate::target::Target;

impl<T: Target> Session<T> {
    /// The context whose program holds the tick in progress, and the time; `None` between two ticks.
    ///
    /// Every call that lets time pass first completes that tick.
    #[must_use]
    pub fn held(&self) -> Option<(ContextId, Cycles)> {
        self.target.held()
    }
}

impl<T: Target> Session<T> {
    /// A measure of the computer's work so far; see [`Target::work`].
    #[must_use]
    pub fn work(&self) -> u64 {
        self.target.work()
    }

    /// Prepares the board for a debugger: tracks the calls in progress from now on.
    pub fn prepare_to_hold(&mut self) {
        self.target.prepare_to_hold();
    }

    /// The programs loaded in the threads.
    #[must_use]
    pub fn programs(&self) -> &[UserProgram] {
        &self.programs
    }

    /// Returns the value of an item of the board by its name in expressions, such as `bit46`.
    #[must_use]
    pub fn item(&self, name: &str) -> Option<f64> {
        Item::among(self.target.axes(), name).ok().map(|item| self.target.value(item))
    }

    /// Holds programs before these instructions, and before no others. The execution and timing of programs stay the
    /// same.
    pub fn set_breakpoints(&mut self, addresses: impl IntoIterator<Item = CodeAddr>) {
        self.target.set_breakpoints(&addresses.into_iter().collect::<Vec<_>>());
    }

    /// Holds a context after each instruction, beginning with the next one; `None` for no context.
    pub fn set_stepping(&mut self, context: Option<ContextId>) {
        self.target.set_stepping(context);
    }

    /// Holds programs after one of these bytes has changed from its present value, and for no others; each range is an
    /// address and a number of bytes.
    pub fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        self.target.set_watched(ranges);
    }

    /// Holds programs after instructions that access these bytes, and after no others.
    pub fn set_accessed(&mut self, ranges: &[AccessRange]) {
        self.target.set_accessed(ranges);
    }

    /// Takes the index of a watched byte that has changed between two instructions.
    pub fn take_change(&mut self) -> Option<usize> {
        self.target.take_change()
    }

    /// Takes the context that was held last, and the reason.
    pub fn take_hold(&mut self) -> Option<Hold> {
        self.target.take_hold()
    }

    /// The calls in progress of a context, innermost first.
    #[must_use]
    pub fn frames(&self, id: ContextId) -> Vec<FrameView> {
        self.target.frames(id)
    }

    /// Sets a register of a call in progress, where 0 is the innermost call; returns whether there is such a register.
    ///
    /// The change is not in the journal; a [timeline](super::Timeline) must be informed by
    /// [`branch`](super::Timeline::branch).
    pub fn set_register(&mut self, id: ContextId, frame: usize, register: u16, slot: u64) -> bool {
        self.target.set_register(id, frame, register, slot)
    }

    /// Calls a function of a program or of the firmware in a context; each argument is a slot. Afterwards the time and
    /// the context are as before. Values stored by the function remain, and are not in the journal, as with
    /// [`set_register`](Self::set_register); if the call does not end with a result, all memory is as before the call.
    ///
    /// # Errors
    /// The target does not support calls.
    pub fn call_function(
        &mut self,
        id: ContextId,
        function: GuestAddr,
        arguments: &[u64],
    ) -> Result<CallEnd, HostError> {
        self.require(Capability::Calls)?;
        let before = self.snapshot()?;
        let end = self.target.call_function(id, function, arguments);
        if !matches!(end, CallEnd::Returned(_)) {
            self.restore(&before)?;
        }
        Ok(end)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use kmotiondef::{ThreadId, Ticks};
    use runtime::Event;
    use vm::engine::HoldReason;

    use super::*;
    use crate::{Setup, UserProgram};

    const TWO: &str = r#"
        #include "KMotionDef.h"
        int shared, calls;
        void tick(void) { ++calls; }
        int twice(int n) { int i, sum = 0; for (i = 0; i < n; ++i) sum += 2; return sum; }
        main()
        {
            int i;
            UserCallBack = tick;
            for (i = 0; i < 20; ++i)
            {
                shared = twice(i);
                if (i % 4 == 0) Delay_sec(0.0003);
                if (i % 5 == 0) printf("%d\n", shared);
            }
            UserCallBack = 0;
        }
    "#;

    fn session(name: &str) -> Session {
        let file = std::env::temp_dir().join(format!("cc67-held-{name}-{}.c", std::process::id()));
        std::fs::write(&file, TWO).expect("a file");
        let mut setup = Setup::default();
        for number in [1, 2] {
            let thread = ThreadId::new(number).expect("there are 7");
            let program = UserProgram::compile(&file, thread, &setup.options).expect("it is right");
            setup.programs.push(program.started());
        }
        setup.session().expect("a board")
    }

    /// All events of a run to a tick, and the memory at its end; `after` is called each time a program is held.
    fn run(mut session: Session, mut after: impl FnMut(&mut Session)) -> (Vec<Event>, Session) {
        let mut events = Vec::new();
        while session.tick() < Ticks::new(300) || session.held().is_some() {
            session.step(Ticks::new(300), &mut |event| events.push(event));
            after(&mut session);
        }
        (events, session)
    }

    fn assert_same(one: &(Vec<Event>, Session), other: &(Vec<Event>, Session)) {
        assert_eq!(one.0, other.0);
        assert!(one.1.target().memory() == other.1.target().memory(), "memory differs");
    }

    #[test]
    fn stopping_everywhere_does_not_change_a_run() {
        let plain = run(session("all"), |_| ());
        assert!(plain.0.len() > 4, "{:?}", plain.0);
        let mut held = session("all");
        let all = ThreadId::all().filter_map(|thread| held.target().machine().program(thread)).flat_map(
            |program| {
                program.functions().iter().flat_map(|function| {
                    function.body.clone().map(|word| program.address_of(word)).collect::<Vec<_>>()
                })
            },
        );
        let all: Vec<_> = all.collect();
        held.set_breakpoints(all);
        let mut seen = BTreeSet::new();
        let held = run(held, |session| {
            if let Some(Hold { context, reason: HoldReason::Breakpoint }) = session.take_hold() {
                seen.insert((context, session.frames(context)[0].at));
            }
        });
        assert_same(&plain, &held);
        assert!(seen.iter().any(|(context, _)| *context == ContextId::CALLBACK) && seen.len() > 40);

        let mut stepped = session("all");
        let two = ContextId::of(ThreadId::new(2).expect("there are 7"));
        stepped.set_stepping(Some(two));
        let mut steps = 0;
        let stepped = run(stepped, |session| {
            let hold = session.take_hold();
            assert!(hold.is_none_or(|hold| hold == Hold { context: two, reason: HoldReason::Step }));
            steps += usize::from(hold.is_some());
            if hold.is_some() {
                // A snapshot taken while a program is held can replace the session.
                let snapshot = session.snapshot().expect("it has snapshots");
                session.restore(&snapshot).expect("it is of this session");
                session.set_stepping(Some(two));
            }
        });
        assert_same(&plain, &stepped);
        assert!(steps > 1000, "{steps}");
    }

    #[test]
    fn the_writer_of_a_watched_variable_is_known() {
        let plain = run(session("who"), |_| ());
        let mut watched = session("who");
        let address = watched.target().debug(ThreadId::new(1).expect("there are 7")).and_then(|_| {
            let inspection = compiler::inspect::Inspection::read(&watched.programs[0].image).ok()?;
            let entry = inspection.symbols.iter().find(|entry| entry.name == "shared")?;
            Some(GuestAddr::new(entry.address))
        });
        watched.set_watched(&[(address.expect("it is a variable"), 4)]);
        let mut values = Vec::new();
        let watched = run(watched, |session| {
            if let Some(Hold { reason: HoldReason::Changed { by: Some(_), index: 0 }, .. }) =
                session.take_hold()
            {
                values.push(session.read("1:shared").expect("it is a variable"));
            }
        });
        assert_same(&plain, &watched);
        assert_eq!(values, (1..20).map(|i| f64::from(2 * i)).collect::<Vec<_>>());
    }
}
