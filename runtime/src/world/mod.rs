//! The surroundings of the board: a stimulus that drives its lines, an operator, and the recorder.

mod access;
pub(crate) mod attached;
pub(crate) mod outside;
pub mod stimulus;
pub mod trace;

pub(crate) use access::{Moment, WorldAccess};

use kmotiondef::{Cycles, ThreadId};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;
use vm::scheduler::SliceOwner;

use crate::io::Io;
use crate::io::changes;
use crate::out::{EventKind, Message, Out, Speaker};
use crate::world::stimulus::{Assist, Player, Step, Stimulus};
use crate::world::trace::{Item, Quantity, Record, Recorder, View};
use chips::changes::BitChange;

/// The world outside the board: the stimulus that acts on it, and the recorder that samples it.
#[derive(Clone, Debug, Default)]
pub(crate) struct World {
    /// True if characters that the UART sends are reported.
    hears_uart: bool,
    /// The stimulus, if there is one.
    stimulus: Option<Box<Player>>,
    /// The operator, if there is one.
    pub(crate) assist: Option<Assist>,
    /// The recorder, if there is one.
    recorder: Option<Box<Recorder>>,
}

impl World {
    /// Plays a further stimulus.
    pub(crate) fn play(
        &mut self,
        stimulus: Stimulus,
        access: &mut WorldAccess<'_>,
        memory: &mut GuestMemory,
    ) {
        let player = self.stimulus.get_or_insert_with(|| Box::new(Player::new()));
        access.out.keep_lines();
        player.extend(stimulus, access, memory);
        player.watched().for_each(|bit| access.io.pins.watch(bit));
        changes::switch_on(&mut access.io.pins.changes, memory);
    }

    /// Executes the actions due at the beginning of a tick; returns whether there were any.
    pub(crate) fn tick(
        &mut self,
        access: &mut WorldAccess<'_>,
        context: &mut TickContext<'_>,
        moment: Moment,
    ) -> bool {
        self.play_tick(access, context, moment) | self.assist_tick(access)
    }

    fn play_tick(
        &mut self,
        access: &mut WorldAccess<'_>,
        context: &mut TickContext<'_>,
        moment: Moment,
    ) -> bool {
        let hears_now = self.hears_uart && access.io.uart.is_sending();
        if !access.io.pins.changes.is_on() && !hears_now {
            return false;
        }
        changes::scan_virtual_bits(&mut access.io.pins.changes, context.memory, access.now);
        access.io.fpga.tell_pwm(&mut access.io.pins, access.now);
        access.lines().settle();
        let sent = access.machine.run_devices(access.io, access.out, self.hears_uart, access.now);
        let changes = access.io.pins.changes.take();
        if self.records_changes() {
            changes.iter().for_each(|change| tell_change(access, moment, *change));
        }
        self.stimulus.as_mut().is_some_and(|player| player.tick(access, context, &changes, &sent))
    }

    /// Plays an operator from now on.
    pub(crate) fn play_operator(&mut self, now: Cycles) {
        self.assist = Some(Assist::new(now));
    }

    fn assist_tick(&mut self, access: &mut WorldAccess<'_>) -> bool {
        let Some(step) = self.assist.as_mut().and_then(|assist| assist.step(access.now)) else {
            return false;
        };
        let (Step::Press(bit, _) | Step::Release(bit)) = step;
        let level = !access.io.pins.input(bit);
        if let Step::Press(_, reader) = step {
            let speaker = Speaker::from(reader.thread);
            access.out.remark_of(
                access.now,
                speaker,
                reader.at,
                Message::Assisted { bit, level: level.into() },
            );
        }
        access.lines().drive(bit, level);
        true
    }

    /// Starts a recording.
    pub(crate) fn record(&mut self, request: trace::TraceRequest, io: &mut Io, memory: &GuestMemory) {
        if request.changes {
            changes::switch_on(&mut io.pins.changes, memory);
            self.hear_uart(io);
            let items = request.quantities.iter().filter_map(Quantity::item);
            items.filter_map(Item::bit).for_each(|bit| io.pins.watch(bit));
        }
        self.recorder = Some(Box::new(Recorder::new(request)));
    }

    /// Takes the sample of the last of `count` ticks up to `context` that should be sampled.
    #[inline]
    pub(crate) fn sample(&mut self, view: &View<'_>, out: &mut Out, context: &TickContext<'_>, count: u64) {
        let Some(recorder) = &mut self.recorder else { return };
        if let Some(tick) = recorder.sampled_tick(context.tick, count)
            && let Some(record) = recorder.sample(view)
        {
            let back = (context.tick.get() - tick.get()) as i64 * Cycles::PER_TICK.get();
            out.emit(context.now - Cycles::new(back), EventKind::Trace(record));
        }
    }

    /// Returns whether a recording is in progress.
    #[inline]
    pub(crate) const fn is_recording(&self) -> bool {
        self.recorder.is_some()
    }

    /// Returns whether levels and slices are recorded.
    pub(crate) fn records_changes(&self) -> bool {
        self.recorder.as_ref().is_some_and(|recorder| recorder.records_changes())
    }

    /// Returns whether the packets of a thread, or of the call-back for `None`, are recorded.
    pub(crate) fn records_packets(&self, thread: Option<ThreadId>) -> bool {
        self.recorder.as_ref().is_some_and(|recorder| recorder.records_packets(thread))
    }

    /// Returns whether a recorded value changes even when nothing else happens.
    pub(crate) fn records_motion(&self, io: &Io, tick_start: Cycles) -> bool {
        io.fpga.is_telling(&io.pins)
            || self.recorder.as_ref().is_some_and(|recorder| recorder.samples("kstep_analog"))
                && !io.fpga.kstep_output().is_settled(tick_start)
    }

    /// Returns whether the stimulus still has actions for which the run must wait.
    pub(crate) fn is_busy(&self, out: &Out) -> bool {
        let has_shown_lines = out.has_shown_lines();
        self.stimulus.as_ref().is_some_and(|player| player.is_busy(has_shown_lines))
    }

    /// Returns whether the stimulus checks a state in every tick.
    pub(crate) fn is_watching(&self) -> bool {
        self.stimulus.as_ref().is_some_and(|player| player.is_watching())
    }

    /// Returns the number of ticks without any action after the one that began at `now`.
    pub(crate) fn quiet_ticks(&self, out: &Out, now: Cycles) -> u64 {
        if !out.has_shown_lines() {
            return 0;
        }
        let stimulus = self.stimulus.as_ref().map_or(u64::MAX, |player| player.quiet_ticks(now));
        let assist = self.assist.as_ref().map_or(u64::MAX, |assist| assist.quiet_ticks(now));
        stimulus.min(assist)
    }

    /// Ends the run: the final expectations of the stimulus are checked.
    pub(crate) fn finish(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        if let Some(player) = &mut self.stimulus {
            player.finish(access, context);
        }
    }

    /// Reports every character that the UART sends from now on.
    pub(crate) fn hear_uart(&mut self, io: &mut Io) {
        io.uart.listen();
        self.hears_uart = true;
    }
}

/// Records a change of a bit, with the thread that had the processor at the time, unless a generator has made it.
fn tell_change(access: &mut WorldAccess<'_>, moment: Moment, BitChange { at, bit, level }: BitChange) {
    let is_generated = access.io.pins.is_watched(bit) && access.io.pins.is_generated(bit);
    let thread = match moment.turn {
        SliceOwner::User(thread) if (moment.slice_start..access.now).contains(&at) && !is_generated => {
            Some(thread)
        }
        _ => None,
    };
    access.out.emit(at, EventKind::Trace(Record::Bit { bit, level, thread }));
}
