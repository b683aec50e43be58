//! A bench for one device: pins, port and UART without a kernel.

use kmotiondef::variables::ADC_BUFFER_IN;
use kmotiondef::{Bit, Cycles};
use vm::memory::GuestMemory;

use crate::io::{changes, kanalog};
use crate::machine::Loads;
use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::views::TypedAccess;
use crate::world::attached::DeviceSpec;
use chips::fpga::Fpga;
use chips::kanalog::Kanalog;
use chips::pins::Pins;
use chips::uart::Uart;

/// A device and its board.
pub(crate) struct Bench {
    pub(crate) device: Box<dyn AttachedDevice>,
    pub(crate) pins: Pins,
    pub(crate) kanalog: Kanalog,
    pub(crate) uart: Uart,
    pub(crate) fpga: Fpga,
    pub(crate) loads: Loads,
    memory: GuestMemory,
}

/// An instant.
pub(crate) fn us(us: i64) -> Cycles {
    Cycles::new(us * (Cycles::PER_SECOND.get() / 1_000_000))
}

impl Bench {
    /// A device described as in a stimulus.
    pub(crate) fn new(text: &str) -> Self {
        let mut words = text.split(' ');
        let name = words.next().expect("a name").to_owned();
        let settings = words.map(|word| word.split_once('=').expect("a setting"));
        let settings = settings.map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        let device = DeviceSpec { name, settings }.build().unwrap_or_else(|error| panic!("{error}"));
        let mut bench = Self {
            device,
            pins: Pins::default(),
            kanalog: Kanalog::default(),
            uart: Uart::default(),
            fpga: Fpga::default(),
            loads: Loads::default(),
            memory: GuestMemory::new(),
        };
        changes::switch_on(&mut bench.pins.changes, &bench.memory);
        bench
    }

    fn with<R>(&mut self, work: impl FnOnce(&mut dyn AttachedDevice, &mut DeviceContext<'_>) -> R) -> R {
        let mut outside = DeviceContext {
            pins: &mut self.pins,
            kanalog: &mut self.kanalog,
            uart: &mut self.uart,
            fpga: &self.fpga,
            loads: &mut self.loads,
        };
        work(&mut *self.device, &mut outside)
    }

    /// The board drives an output.
    pub(crate) fn output(&mut self, bit: i32, level: bool, at_us: i64) {
        let bit = Bit::new(bit).expect("a bit");
        self.pins.set_output(bit, true, us(at_us));
        self.pins.set_latch(bit, level, us(at_us));
        while let Some(change) = self.pins.changes.next_unseen() {
            self.with(|device, outside| device.edge(change, outside));
        }
    }

    pub(crate) fn tick(&mut self, at_us: i64) {
        self.with(|device, outside| device.tick(us(at_us), outside));
    }

    pub(crate) fn sent(&mut self, byte: u8, at_us: i64) {
        self.with(|device, outside| device.sent(byte, us(at_us), outside));
    }

    pub(crate) fn level(&self, bit: i32) -> bool {
        self.pins.level(Bit::new(bit).expect("a bit"))
    }

    /// The value of an analog input, −2048 to 2047.
    pub(crate) fn adc(&mut self, channel: usize) -> i32 {
        self.memory.set(kmotiondef::variables::KANALOG_PRESENT, 1);
        kanalog::tick(&self.kanalog, &self.fpga, &mut self.memory);
        self.memory.get(ADC_BUFFER_IN.element(channel)) - 2048
    }
}
