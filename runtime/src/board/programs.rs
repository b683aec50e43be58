//! The programs of the seven threads: loaded, downloaded, offered, started and stopped.

use std::sync::Arc;

use kmotiondef::map::ProgramSpaces;
use kmotiondef::structs::Persist;
use kmotiondef::variables::{PERSIST, USER_CALL_BACK};
use kmotiondef::{CodeAddr, GuestAddr, ThreadId};
use vm::engine::Engine;
use vm::loaded::LoadedCode as Code;
use vm::program::Program;
use vm::thread::NotLoaded;
use vm::verify::VerifyError;

use super::{Board, LoadedImage, Programs};
use crate::board::code;
use crate::board::debug::{CodeDetail, DebugInfo, ObjectInfo, SourcePlace};
use crate::board::loader::{Fill, LoadError, PlacedSection, prepare};
use crate::firmware::calls::NamedObject;
use crate::firmware::level::ModelledBoard;
use crate::out::{EventKind, Message};
use crate::views::TypedAccess;

impl<E: Engine> Board<E> {
    /// Loads an image into `thread`, which is stopped first.
    ///
    /// # Errors
    /// The reason for which the image is refused; nothing is changed in that case.
    pub fn load(&mut self, thread: ThreadId, image: &[u8]) -> Result<(), LoadError> {
        self.load_detailed(thread, image, Arc::default())
    }

    /// Loads an image, together with further details about its code from the compiler.
    ///
    /// # Errors
    /// The reason for which the image is refused; nothing is changed in that case.
    pub fn load_detailed(
        &mut self,
        thread: ThreadId,
        image: &[u8],
        details: Arc<[CodeDetail]>,
    ) -> Result<(), LoadError> {
        let prepared = prepare(image, thread, self.modelled_board(), |other| self.is_taken(other, thread))?;
        if self.thread(thread).is_active() {
            let (kernel, context) = self.machine.firmware_mut();
            kernel.parts.out.remark(context.now, Message::ProgramReplaced { thread });
        }
        self.machine.unload_program(thread);
        self.machine.firmware_mut().0.parts.pc.downloads.forget(thread);
        self.machine.firmware_mut().0.parts.calls.globals.remove(thread);
        for section in &prepared.sections {
            self.place(thread, section, &prepared.code);
        }
        self.drop_callback(thread);
        self.drop_konnects(thread);
        let start = self.spaces().start(thread).get();
        let ends = prepared.sections.iter().map(|section| section.address.get() + section.size());
        let extent = start..ends.max().unwrap_or(start);
        let named = |object: &ObjectInfo| NamedObject {
            name: object.name.clone(),
            start: object.start,
            size: object.size,
        };
        let objects: Arc<[NamedObject]> = prepared.debug.objects().iter().map(named).collect();
        let parts = &mut self.machine.firmware_mut().0.parts;
        if let Some(races) = &mut parts.races {
            races.load(thread, Arc::clone(&objects));
        }
        parts.calls.notices.load(thread, objects);
        self.load_code(thread, prepared.code, prepared.entry);
        self.programs_mut().loaded[thread.index()] =
            Some(LoadedImage { debug: prepared.debug.with_details(details), extent });
        Ok(())
    }

    /// The firmware that the board models.
    pub(super) fn modelled_board(&self) -> &ModelledBoard {
        &self.machine.firmware().parts.level
    }

    /// The spaces of the threads' programs.
    fn spaces(&self) -> ProgramSpaces {
        self.modelled_board().board().programs()
    }

    /// Returns the facts about programs, for changes; snapshots keep the old ones.
    pub(super) fn programs_mut(&mut self) -> &mut Programs {
        Arc::make_mut(&mut self.programs)
    }

    /// Returns whether a program of a thread other than `except` is in the space of `thread`.
    pub(super) fn is_taken(&self, thread: ThreadId, except: ThreadId) -> bool {
        let space = self.spaces().space(thread);
        let others = ThreadId::all().filter(|&other| other != except);
        let mut extents = others.filter_map(|other| self.programs.loaded[other.index()].as_ref());
        extents.any(|loaded| loaded.extent.start < space.end && loaded.extent.end > space.start)
    }

    /// Writes a section to memory; the loader has checked that it fits.
    pub(super) fn place(&mut self, thread: ThreadId, section: &PlacedSection, code: &Code) {
        let bytes = match &section.contents {
            Fill::Bytes(bytes) => bytes.clone(),
            Fill::Uninitialised(size) => vec![self.bss_fill; *size as usize],
        };
        let placed = self.machine.memory_mut().poke_bytes(section.address, &bytes);
        debug_assert!(placed.is_ok(), "the loader checks that sections lie in memory");
        if !code.text().contains(&section.address) {
            self.machine.firmware_mut().0.parts.calls.globals.record_section(thread, section.address, &bytes);
        }
    }

    /// Removes a call-back whose code a load has replaced; the board would execute the new bytes.
    pub(super) fn drop_callback(&mut self, thread: ThreadId) {
        let callback = self.memory().get(USER_CALL_BACK);
        if self.spaces().space(thread).contains(&callback.get()) {
            let (kernel, context) = self.machine.firmware_mut();
            context.memory.set(USER_CALL_BACK, GuestAddr::NULL);
            kernel.parts.out.remark(context.now, Message::CallBackDropped { thread });
        }
    }

    /// Ends the service of Konnect boards whose words a load has replaced.
    pub(super) fn drop_konnects(&mut self, thread: ThreadId) {
        let space = self.spaces().space(thread);
        let (kernel, context) = self.machine.firmware_mut();
        if kernel.parts.io.konnects.drop_within(&space) {
            kernel.parts.out.remark(context.now, Message::KonnectDropped { thread });
        }
    }

    /// Returns the debug information of the image in `thread`.
    #[must_use]
    pub fn debug(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.programs.loaded[thread.index()].as_ref().map(|loaded| &loaded.debug)
    }

    /// The source position of a code address in any thread's program.
    #[must_use]
    pub fn source(&self, address: CodeAddr) -> Option<SourcePlace<'_>> {
        self.programs.loaded.iter().flatten().find_map(|loaded| loaded.debug.place(address))
    }

    /// Makes `thread` ready to run a program that is already in guest memory.
    pub fn load_program(&mut self, thread: ThreadId, program: Program, entry: GuestAddr) {
        self.load_code(thread, Code::Program(program.into()), entry);
    }

    /// Makes `thread` ready to run code of any kind.
    fn load_code(&mut self, thread: ThreadId, code: Code, entry: GuestAddr) {
        let entry_points = PERSIST.field(Persist::ENTRY_POINTS);
        self.machine.memory_mut().set(entry_points.element(thread.index()), entry.get());
        self.hand_over(thread, code, entry);
    }

    /// Gives the machine code; bytecode has the costs of the machine file, code of the processor its cycles.
    pub(super) fn hand_over(&mut self, thread: ThreadId, code: Code, entry: GuestAddr) {
        let code = match code {
            Code::Program(program) if self.cost != 1.0 => {
                Code::Program(Arc::unwrap_or_clone(program).with_costs_scaled(self.cost).into())
            }
            other => other,
        };
        if code.program().is_none() {
            let (kernel, context) = self.machine.firmware_mut();
            if kernel.parts.races.is_some() {
                kernel.parts.out.remark(context.now, Message::NotWatched { thread });
            }
        }
        self.machine.load(thread, code, entry);
    }

    /// Starts `thread` at its entry point.
    ///
    /// # Errors
    /// [`NotLoaded`] for an empty thread.
    pub fn start(&mut self, thread: ThreadId) -> Result<(), NotLoaded> {
        self.machine.start(thread)
    }

    /// Keeps an image that a stimulus may load into `thread` under this name; returns the facts about its program.
    ///
    /// # Errors
    /// The reason for which the image would be refused.
    pub fn offer(
        &mut self,
        thread: ThreadId,
        name: &str,
        image: Vec<u8>,
        details: Arc<[CodeDetail]>,
    ) -> Result<DebugInfo, LoadError> {
        let debug =
            prepare(&image, thread, self.modelled_board(), |_| false)?.debug.with_details(details.clone());
        self.programs_mut().offered.insert((thread, name.into()), (image, details));
        Ok(debug)
    }

    /// Loads an image that was offered and starts it.
    pub(super) fn run_offered(&mut self, thread: ThreadId, name: &Arc<str>) {
        let result = match self.programs.offered.get(&(thread, name.clone())).cloned() {
            Some((image, details)) => {
                self.load_detailed(thread, &image, details).map_err(|error| error.to_string())
            }
            None => Err("nobody has compiled it".to_owned()),
        };
        let started = result.and_then(|()| self.start(thread).map_err(|error| error.to_string()));
        let (kernel, context) = self.machine.firmware_mut();
        let out = &mut kernel.parts.out;
        match started {
            Ok(()) => out.emit(context.now, EventKind::Loaded(thread, name.clone())),
            Err(error) => {
                let name = name.to_string();
                out.remark(context.now, Message::NotRun { name, thread, error });
            }
        }
    }

    /// Makes a program from the download into a thread that was started.
    pub(super) fn load_download(&mut self, thread: ThreadId) {
        let error = match self.take_download(thread) {
            Ok(true) => {
                let started = self.machine.start(thread);
                debug_assert!(started.is_ok(), "a program was loaded");
                return;
            }
            // Only the entry point is new.
            Ok(false) if self.machine.loaded(thread).is_some() => return,
            Ok(false) => "nothing was downloaded to the beginning of its space".to_owned(),
            Err(error) => error.to_string(),
        };
        self.machine.unload_program(thread);
        let (kernel, context) = self.machine.firmware_mut();
        kernel.parts.out.remark(context.now, Message::NotStarted { thread, error });
    }

    /// Makes a program from the download into a thread; returns whether there was one.
    pub(super) fn take_download(&mut self, thread: ThreadId) -> Result<bool, VerifyError> {
        let entry = self.machine.threads().entry(thread);
        let (kernel, _) = self.machine.firmware_mut();
        let ends = kernel.parts.pc.downloads.ends(thread);
        kernel.parts.pc.downloads.forget(thread);
        let Some(code) = self.downloaded_program(thread, &ends)? else { return Ok(false) };
        self.programs_mut().loaded[thread.index()] = None;
        self.machine.firmware_mut().0.parts.calls.globals.remove(thread);
        self.hand_over(thread, code, entry);
        Ok(true)
    }

    /// The program whose text ends at one of several addresses; `None` if nothing was downloaded.
    pub(super) fn downloaded_program(
        &self,
        thread: ThreadId,
        ends: &[GuestAddr],
    ) -> Result<Option<Code>, VerifyError> {
        let base = self.spaces().start(thread);
        let mut error = None;
        for end in ends {
            let text = self.memory().read_bytes(base, end.get() - base.get()).unwrap_or_default();
            match code::code_without_image(text, base, self.modelled_board()) {
                Ok(code) => return Ok(Some(code)),
                // The error of the longest range is the error of the text.
                Err(wrong) => error = Some(wrong),
            }
        }
        error.map_or(Ok(None), Err)
    }

    /// Stops the user threads.
    pub fn stop_threads(&mut self, threads: impl IntoIterator<Item = ThreadId>) {
        for thread in threads {
            self.machine.threads_mut().pause(thread);
        }
    }
}
