//! The map from addresses to devices (`dsp-board.md` 3).

use chips::flash::Chip;
use kmotiondef::map::{FLASH, FPGA, IRAM, ROM_SIZE, SDRAM};
use kmotiondef::{Cycles, GuestAddr};
use vm::dsp::{Clock, Memory};
use vm::memory::GuestMemory;
use vm::trap::{Access, TrapKind};

use super::control::Control;
use super::external::ExternalHardware;
use super::flash;
use super::timer::Timer;
use super::window::Window;

/// The addresses of the timer.
const TIMER: u32 = 0x4200_0000;
const TIMER_SIZE: u32 = 0x100;

/// All devices that the processor can access.
#[derive(Clone, Debug)]
pub(super) struct Hardware<A = ()> {
    pub(super) memory: GuestMemory,
    pub(super) timer: Timer,
    pub(super) window: Window<A>,
    pub(super) control: Control,
    pub(super) chip: Chip,
    /// The cycle in which the firmware first polled the link to the PC.
    pub(super) first_look: Option<u64>,
    /// True if an unmapped address reads as 0 and ignores writes, as on a board; otherwise an access ends the run.
    pub(super) forgives: bool,
    /// The number of cycles for which the processor waits at an access outside RAM, as in the recordings with waits.
    pub(super) register_waits: u32,
    /// The number of device accesses, except polls of an empty link.
    pub(super) touches: u64,
}

impl<A> Default for Hardware<A> {
    fn default() -> Self {
        Self {
            memory: GuestMemory::default(),
            timer: Timer::default(),
            window: Window::default(),
            control: Control::default(),
            chip: Chip::default(),
            first_look: None,
            forgives: false,
            register_waits: 0,
            touches: 0,
        }
    }
}

impl<A: ExternalHardware> Hardware<A> {
    /// Connects external hardware.
    pub(super) fn connect<B: ExternalHardware>(self, external: Option<B>, now: u64) -> Hardware<B> {
        let Self { memory, timer, window, control, chip, first_look, forgives, register_waits, touches } =
            self;
        let window = window.connect(external, now);
        Hardware { memory, timer, window, control, chip, first_look, forgives, register_waits, touches }
    }

    #[cold]
    fn load(&mut self, addr: u32, bytes: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        let now = clock.cycle();
        clock.stall(u64::from(self.register_waits));
        if let Some(offset) = offset_in_range(addr, FPGA.base.get(), FPGA.size) {
            return Ok(self.read_register(offset, bytes, now, clock));
        }
        self.touches += 1;
        if let Some(offset) = offset_in_range(addr, TIMER, TIMER_SIZE) {
            return Ok(self.timer.read(offset, now));
        }
        if let Some(offset) = offset_in_range(addr, FLASH.base.get(), FLASH.size) {
            return Ok(self.flash(offset, bytes, now));
        }
        if Control::has(addr) {
            return Ok(self.control.read(addr));
        }
        if addr < ROM_SIZE || self.forgives { Ok(0) } else { Err(unmapped_trap(addr, Access::Read)) }
    }

    fn flash(&mut self, offset: u32, bytes: u32, now: u64) -> u32 {
        let now = Cycles::new(now.cast_signed());
        let low = flash::read(&mut self.chip, offset & !1, &self.memory, now);
        match bytes {
            1 => low >> (8 * (offset & 1)) & 0xFF,
            2 => low,
            _ => low | flash::read(&mut self.chip, offset | 2, &self.memory, now) << 16,
        }
    }

    /// Reads a register of the FPGA. At the first poll of the link the processor stops: the board is ready.
    fn read_register(&mut self, offset: u32, bytes: u32, now: u64, clock: &mut Clock) -> u32 {
        let (looks, touches) = (self.window.link.poll_count(), self.window.touches());
        let value = self.window.read(offset, bytes, now);
        self.touches += self.window.touches() - touches;
        if self.first_look.is_none() && self.window.link.poll_count() != looks {
            self.first_look = Some(clock.cycle());
            clock.set_left(0);
        }
        value
    }

    #[cold]
    fn store(&mut self, addr: u32, bytes: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        let now = clock.cycle();
        clock.stall(u64::from(self.register_waits));
        self.touches += 1;
        if let Some(offset) = offset_in_range(addr, FPGA.base.get(), FPGA.size) {
            self.window.write(offset, bytes, value, now);
        } else if let Some(offset) = offset_in_range(addr, TIMER, TIMER_SIZE) {
            self.timer.write(offset, value, now);
            let left = self.timer.next_match().saturating_sub(now);
            clock.set_left(clock.left().min(i64::try_from(left).unwrap_or(i64::MAX)));
        } else if let Some(offset) = offset_in_range(addr, FLASH.base.get(), FLASH.size) {
            let now = Cycles::new(now.cast_signed());
            flash::write(&mut self.chip, offset & !1, value as u16, &mut self.memory, now);
        } else if Control::has(addr) {
            self.control.write(addr, value);
        } else if addr >= ROM_SIZE && !self.forgives {
            return Err(unmapped_trap(addr, Access::Write));
        }
        Ok(())
    }

    /// A word of RAM, which may contain code.
    pub(super) fn word(&self, addr: u32) -> Option<u32> {
        let is_ram = |region: &kmotiondef::map::Region| addr.wrapping_sub(region.base.get()) < region.size;
        (is_ram(&SDRAM) || is_ram(&IRAM)).then(|| self.memory.peek(GuestAddr::new(addr)))
    }
}

const fn offset_in_range(addr: u32, base: u32, size: u32) -> Option<u32> {
    let offset = addr.wrapping_sub(base);
    if offset < size { Some(offset) } else { None }
}

const fn unmapped_trap(addr: u32, access: Access) -> TrapKind {
    TrapKind::Unmapped { addr: GuestAddr::new(addr), access }
}

impl<A: ExternalHardware> Memory for Hardware<A> {
    fn touches(&self) -> u64 {
        self.touches
    }

    fn fetch(&self, addr: u32) -> Option<u32> {
        self.word(addr)
    }

    #[inline(always)]
    fn load8(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        match self.memory.load_ram::<u8>(GuestAddr::new(addr)) {
            Some(value) => Ok(u32::from(value)),
            None => self.load(addr, 1, clock),
        }
    }

    #[inline(always)]
    fn load16(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        match self.memory.load_ram::<u16>(GuestAddr::new(addr)) {
            Some(value) => Ok(u32::from(value)),
            None => self.load(addr, 2, clock),
        }
    }

    #[inline(always)]
    fn load32(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        match self.memory.load_ram(GuestAddr::new(addr)) {
            Some(value) => Ok(value),
            None => self.load(addr, 4, clock),
        }
    }

    #[inline(always)]
    fn load64(&mut self, addr: u32, clock: &mut Clock) -> Result<u64, TrapKind> {
        if let Some(value) = self.memory.load_ram(GuestAddr::new(addr)) {
            return Ok(value);
        }
        let low = self.load32(addr, clock)?;
        let high = self.load32(addr.wrapping_add(4), clock)?;
        Ok(u64::from(low) | u64::from(high) << 32)
    }

    #[inline(always)]
    fn store8(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        match self.memory.store_ram(GuestAddr::new(addr), value as u8) {
            Some(()) => Ok(()),
            None => self.store(addr, 1, value, clock),
        }
    }

    #[inline(always)]
    fn store16(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        match self.memory.store_ram(GuestAddr::new(addr), value as u16) {
            Some(()) => Ok(()),
            None => self.store(addr, 2, value, clock),
        }
    }

    #[inline(always)]
    fn store32(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        match self.memory.store_ram(GuestAddr::new(addr), value) {
            Some(()) => Ok(()),
            None => self.store(addr, 4, value, clock),
        }
    }
}
