//! Power-up from flash, and saving to flash.

use kmotiondef::map::FLASH;
use kmotiondef::structs::Persist;
use kmotiondef::variables::{HOST_STATUS, PERSIST};
use kmotiondef::{GuestAddr, ThreadId};
use vm::engine::Engine;
use vm::loaded::LoadedCode as Code;
use vm::memory::GuestMemory;

use super::{Board, LoadedImage};
use crate::board::code;
use crate::board::power_up::{self, InitialMemory};
use crate::io::flash;
use crate::out::Message;
use crate::servo::independent;
use crate::servo::moves::Planner;
use crate::views::TypedAccess;

impl<E: Engine> Board<E> {
    /// Fills memory from flash, or with the power-up values if nothing was flashed, and starts the programs that are
    /// set to start by themselves. From then on a board that `is_strict` shows one bank of flash.
    pub(super) fn power_up(&mut self, is_strict: bool) {
        let memory = self.machine.memory_mut();
        let before = if flash::is_saved(memory) { InitialMemory::Flashed } else { InitialMemory::Zero };
        if before == InitialMemory::Flashed {
            flash::restore(memory);
        }
        let board = self.modelled_board().board();
        power_up::fill(self.machine.memory_mut(), board.version, before);
        power_up::fill_later(self.machine.memory_mut(), board);
        if self.machine.firmware().parts.servo.planner == Planner::Direct {
            independent::prepare(self.machine.memory_mut());
        }
        if before == InitialMemory::Flashed {
            ThreadId::all().for_each(|thread| self.load_flashed(thread));
            let starts = self.memory().get(PERSIST.field(Persist::RUN_ON_START_UP));
            for thread in ThreadId::all().filter(|thread| starts & 1 << thread.get() != 0) {
                // A thread without a program has nothing to start.
                let _ = self.machine.start(thread);
            }
        }
        let (kernel, context) = self.machine.firmware_mut();
        let status = i32::from(kernel.parts.pc.host.has_job());
        context.memory.set(HOST_STATUS, status);
        if is_strict {
            kernel.parts.io.flash.be_strict(context.memory);
        }
    }

    /// Sets the board of memory: its map, the addresses of the firmware's variables, and its axes.
    pub(super) fn set_places(&mut self) {
        let (places, board) = (self.modelled_board().places(), self.modelled_board().board());
        let (map, axes) = (board.map(), board.axes);
        let memory = self.machine.memory_mut();
        memory.set_map(map);
        memory.set_places(places);
        memory.set_axes(axes);
    }

    /// Makes a program from the flashed bytes of a thread.
    pub(super) fn load_flashed(&mut self, thread: ThreadId) {
        let Some(text) = flash::text(self.memory(), thread) else { return };
        let length = text.end.get() - text.start.get();
        let bytes = self.memory().read_bytes(text.start, length).unwrap_or_default();
        match code::code_without_image(bytes, text.start, self.modelled_board()) {
            Ok(code) => {
                let entry = self.memory().get(PERSIST.field(Persist::ENTRY_POINTS).element(thread.index()));
                self.hand_over(thread, code, GuestAddr::new(entry));
                let extent = text.start.get()..text.end.get();
                let debug = self.programs.flashed[thread.index()].clone().unwrap_or_default();
                self.programs_mut().loaded[thread.index()] = Some(LoadedImage { debug, extent });
            }
            Err(error) => {
                let (kernel, context) = self.machine.firmware_mut();
                let message = Message::NotFlashed { thread, error: error.to_string() };
                kernel.parts.out.remark(context.now, message);
            }
        }
    }

    /// Saves programs and settings in flash.
    pub(super) fn save(&mut self) {
        if self.memory().map().flash.is_none() {
            let (kernel, context) = self.machine.firmware_mut();
            return kernel.parts.out.remark(context.now, Message::NoFlash {});
        }
        self.take_downloads();
        let texts: Vec<_> =
            ThreadId::all().map(|thread| self.machine.loaded(thread).map(Code::code)).collect();
        let (kernel, context) = self.machine.firmware_mut();
        kernel.parts.io.flash.with_chip(context.memory, |memory| {
            flash::save(memory, |thread| texts.get(thread.index()).cloned().flatten());
        });
        let programs = self.programs_mut();
        let known = |loaded: &Option<LoadedImage>| loaded.as_ref().map(|loaded| loaded.debug.clone());
        programs.flashed = programs.loaded.each_ref().map(known);
    }

    /// Makes programs from the downloads into threads that have not been started since.
    fn take_downloads(&mut self) {
        for thread in ThreadId::all() {
            if self.machine.threads().state(thread).is_active() {
                continue;
            }
            if let Err(error) = self.take_download(thread) {
                let (kernel, context) = self.machine.firmware_mut();
                let message = Message::NotFlashed { thread, error: error.to_string() };
                kernel.parts.out.remark(context.now, message);
            }
        }
    }

    /// Restarts from flash. Time continues: it counts from the first power-up.
    pub(super) fn reboot(&mut self) {
        ThreadId::all().for_each(|thread| self.machine.unload_program(thread));
        self.programs_mut().loaded = Default::default();
        let flash = self.flash().to_vec();
        let is_strict = self.machine.firmware().parts.io.flash.chip().is_some();
        let memory = self.machine.memory_mut();
        *memory = GuestMemory::new();
        self.set_places();
        let memory = self.machine.memory_mut();
        if memory.map().flash.is_some() {
            let stored = memory.poke_bytes(FLASH.base, &flash);
            debug_assert!(stored.is_ok(), "flash is mapped");
        }
        self.machine.firmware_mut().0.restart();
        self.power_up(is_strict);
    }

    /// Returns the contents of flash memory.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        let seen = || self.memory().read_bytes(FLASH.base, FLASH.size).unwrap_or_default();
        self.machine.firmware().parts.io.flash.chip().unwrap_or_else(seen)
    }
}
