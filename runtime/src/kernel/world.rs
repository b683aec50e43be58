//! The world around the board within a tick: devices on pins, the stimulus, the operator, and who records it all.

use kmotiondef::{Bit, Cycles};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;
use vm::scheduler::Turn;

use super::Kernel;
use crate::firmware::io::bit_state;
use crate::io::changes::BitChange;
use crate::out::EventKind;
use crate::world::attached::{Attached, Outside};
use crate::world::stimulus::{Assist, Player, Step, Stimulus};
use crate::world::trace::{self, Item, Quantity, Record, Recorder};

/// Edges that devices may answer at one instant.
const EDGES_AT_ONCE: usize = 10_000;

impl Kernel {
    /// Lets the world act as a stimulus says, beside what it does already.
    pub(crate) fn play(&mut self, stimulus: Stimulus, memory: &mut GuestMemory) {
        let mut player = self.stimulus.take().unwrap_or_else(|| Box::new(Player::new()));
        player.extend(stimulus, self, memory);
        player.watched().for_each(|bit| self.pins.watch(bit));
        self.stimulus = Some(player);
        self.pins.changes.switch_on(memory);
    }

    /// The world's part of a tick; whether it did anything.
    pub(super) fn play_tick(&mut self, context: &mut TickContext<'_>) -> bool {
        if !self.pins.changes.is_on() && !self.hears_uart {
            return false;
        }
        self.pins.changes.sweep(context.memory, context.now);
        self.fpga.tell_pwm(&mut self.pins, context.now);
        self.settle(context.now);
        self.run_devices(context.now);
        let changes = self.pins.changes.take();
        if self.recorder.as_ref().is_some_and(|recorder| recorder.records_changes()) {
            changes.iter().for_each(|change| self.tell_change(*change, context.now));
        }
        let Some(mut player) = self.stimulus.take() else { return false };
        let acted = player.tick(self, context, &changes);
        self.stimulus = Some(player);
        acted
    }

    /// Tells a change of a bit, and the thread that had the processor then, unless a generator has made it.
    fn tell_change(&mut self, BitChange { at, bit, level }: BitChange, now: Cycles) {
        let is_generated = self.pins.is_watched(bit) && self.pins.is_generated(bit);
        let thread = match self.turn {
            Turn::User(thread) if (self.slice_start..now).contains(&at) && !is_generated => Some(thread),
            _ => None,
        };
        self.tell(at, EventKind::Trace(Record::Bit { bit, level, thread }));
    }

    /// Plays an operator from now on.
    pub(crate) fn assist(&mut self, now: Cycles) {
        self.assist = Some(Assist::new(now));
    }

    /// What the operator does in a tick; whether that is anything.
    pub(super) fn assist_tick(&mut self, now: Cycles) -> bool {
        let Some(step) = self.assist.as_mut().and_then(|assist| assist.step(now)) else { return false };
        let (Step::Press(bit, _) | Step::Release(bit)) = step;
        let level = !self.pins.input(bit);
        if let Step::Press(_, thread) = step {
            self.tell(now, EventKind::Assisted { bit, level, thread, place: None });
        }
        self.pins.drive(bit, level, now);
        self.settle(now);
        true
    }

    /// Records from now on.
    pub(crate) fn record(&mut self, request: trace::Request, memory: &GuestMemory) {
        if request.changes {
            self.pins.changes.switch_on(memory);
            self.hear_uart();
            let items = request.quantities.iter().filter_map(Quantity::item);
            items.filter_map(Item::bit).for_each(|bit| self.pins.watch(bit));
        }
        self.recorder = Some(Box::new(Recorder::new(request)));
    }

    /// Samples what is recorded at the last of `count` ticks that is to be sampled.
    #[inline]
    pub(super) fn sample(&mut self, context: &TickContext<'_>, count: u64) {
        if self.recorder.is_some() {
            self.record_sample(context, count);
        }
    }

    fn record_sample(&mut self, context: &TickContext<'_>, count: u64) {
        let Some(mut recorder) = self.recorder.take() else { return };
        if let Some(tick) = recorder.sampled_tick(context.tick, count)
            && let Some(record) = recorder.sample(self, context.memory)
        {
            let back = (context.tick.get() - tick.get()) as i64 * Cycles::PER_TICK.get();
            self.tell(context.now - Cycles::new(back), EventKind::Trace(record));
        }
        self.recorder = Some(recorder);
    }

    /// Whether what is recorded changes even when nothing happens.
    pub(super) fn records_motion(&self) -> bool {
        self.fpga.is_telling(&self.pins)
            || self.recorder.as_ref().is_some_and(|recorder| recorder.samples("kstep_analog"))
                && !self.fpga.kstep_output().is_settled(self.tick_start)
    }

    /// The run is over: what the stimulus expects then is checked.
    pub(crate) fn finish(&mut self, context: &mut TickContext<'_>) {
        if let Some(mut player) = self.stimulus.take() {
            player.finish(self, context);
            self.stimulus = Some(player);
        }
    }

    /// Attaches a device and shows it what is high.
    pub(crate) fn attach(&mut self, mut device: Box<dyn Attached>, memory: &GuestMemory, now: Cycles) {
        self.pins.changes.switch_on(memory);
        Bit::all().filter(|&bit| device.watches(bit)).for_each(|bit| self.pins.watch(bit));
        self.uart.listen();
        let high = Bit::all().filter(|&bit| bit_state(self, memory, bit).0).collect::<Vec<_>>();
        let (mut outside, _) = self.outside();
        for bit in high {
            device.edge(BitChange { at: now, bit, level: true }, &mut outside);
        }
        device.tick(now, &mut outside);
        self.attached.push(device);
        self.settle(now);
    }

    /// What devices reach, and the devices.
    fn outside(&mut self) -> (Outside<'_>, &mut [Box<dyn Attached>]) {
        let outside = Outside {
            pins: &mut self.pins,
            kanalog: &mut self.kanalog,
            uart: &mut self.uart,
            fpga: &self.fpga,
            servo: &mut self.servo,
        };
        (outside, &mut self.attached)
    }

    /// Bits may have changed: devices that listen to them answer.
    pub(crate) fn settle(&mut self, now: Cycles) {
        if self.attached.is_empty() {
            return;
        }
        // Devices that answer each other for ever do so at one instant: that is where it is broken off.
        for _ in 0..EDGES_AT_ONCE {
            let Some(change) = self.pins.changes.next_unseen() else { return };
            let (mut outside, devices) = self.outside();
            for device in devices {
                device.edge(change, &mut outside);
            }
        }
        self.attached.clear();
        let text = "devices on bits answer each other without end: they are taken off".to_owned();
        self.tell(now, EventKind::Diagnostic(text));
    }

    /// What devices do at the beginning of a tick.
    fn run_devices(&mut self, now: Cycles) {
        while let Some((at, byte)) = self.uart.take_sent(now) {
            let (mut outside, devices) = self.outside();
            for device in devices {
                device.sent(byte, at, &mut outside);
            }
            if self.hears_uart {
                self.tell(at, EventKind::UartSent(byte));
            }
        }
        let (mut outside, devices) = self.outside();
        for device in devices {
            device.tick(now, &mut outside);
        }
        self.settle(now);
    }

    /// Tells every character that the UART sends from now on.
    pub(crate) fn hear_uart(&mut self) {
        self.uart.listen();
        self.hears_uart = true;
    }
}
