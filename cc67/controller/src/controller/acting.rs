//! Starting threads, and actions that need the monitor or the board's data recorder.

use cc67_host::target::Target as _;
use cc67_host::{EventSink, HostError};
use cc67_wire::LoadImage;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::variables::GATHER_BUFFER;
use kmotiondef::{Cycles, GuestAddr, ThreadId};
use runtime::trace::{Record, TraceRequest};
use runtime::{Event, EventKind};

use super::{Controller, link};
use crate::clock::now;
use crate::recording::{BoardRecording, BoardSample, RecordingError};

impl Controller {
    /// Starts the programs that wait until time passes.
    pub(super) fn start_waiting(&mut self) {
        let waiting = self.threads.take_waiting();
        if !waiting.is_empty() {
            self.time.origin = now();
            if let Err(error) = self.start_together(&waiting) {
                self.pending.push(EventKind::Host(error.to_string()));
            }
        }
    }

    pub(super) fn begin_recording(&mut self, request: &TraceRequest) -> Result<(), HostError> {
        let mut pointer = [0; 4];
        self.read(self.place_of(GATHER_BUFFER.address()), &mut pointer)?;
        let buffer = GuestAddr::new(u32::from_le_bytes(pointer));
        let recording = BoardRecording::new(request, |address| self.seen.place_of(address), buffer);
        let recording = recording.map_err(|RecordingError(what)| HostError::Link(what))?;
        recording.begin(self.client.get_mut()).map_err(link)?;
        self.recording = Some(recording);
        Ok(())
    }

    /// Ends the recording, and passes on its samples.
    pub(super) fn end_recording(&mut self, events: EventSink<'_>) {
        let Some(recording) = self.recording.take().filter(|_| self.lost.is_none()) else { return };
        if let Err(error) = self.read_recording(&recording, events) {
            let at = self.now();
            events(Event { at, kind: EventKind::Host(format!("the recording cannot be read: {error}")) });
        }
    }

    pub(super) fn read_recording(
        &mut self,
        recording: &BoardRecording,
        events: EventSink<'_>,
    ) -> Result<(), HostError> {
        let at = self.now();
        let (descriptor, length) = recording.head();
        let mut head = vec![0; length];
        self.monitor.get_mut().note_change();
        self.read(descriptor, &mut head)?;
        let board = self.client.get_mut();
        let mut say = |text: String| events(Event { at, kind: EventKind::Host(text) });
        let Some(end) = recording.end_of(board, &head).map_err(link)? else {
            say("a program has used the board's data recorder: nothing is recorded".to_owned());
            return Ok(());
        };
        let seconds = f64::from(end.samples) * TIMEBASE;
        if end.is_full {
            say(format!("the recording ends after {seconds:.3} s: the board's buffer is full"));
        }
        let read = recording.read(board, end.samples, &mut |sample| {
            let at = Cycles::new((sample.tick as i64 + 1) * Cycles::PER_TICK.get());
            let BoardSample { values, enabled, .. } = sample;
            events(Event { at, kind: EventKind::Trace(Record::Sample { values, enabled }) });
        });
        read.map_err(link)
    }

    /// Starts threads without a pause between them.
    pub(super) fn start_together(&mut self, threads: &[ThreadId]) -> Result<(), HostError> {
        self.client.get_mut().execute(threads).map_err(link)?;
        threads.iter().for_each(|thread| self.threads.note_started(*thread));
        self.time.next_status = now();
        Ok(())
    }

    /// Pauses or resumes a thread.
    pub(super) fn set_paused(&mut self, thread: ThreadId, is_paused: bool) -> Result<(), HostError> {
        let free = self.threads.free();
        let monitor = self.monitor.get_mut();
        monitor.note_change();
        monitor.pause(self.client.get_mut(), &free, thread, is_paused)
    }

    /// Compares the memory of the board with a loaded program.
    pub(super) fn verify(&mut self, image: &LoadImage) -> Result<(), HostError> {
        let free = self.threads.free();
        for (address, bytes) in &image.parts {
            let monitor = self.monitor.get_mut();
            let place = GuestAddr::new(*address);
            if !monitor.verify(self.client.get_mut(), &free, place, bytes)? {
                return Err(HostError::Link(format!(
                    "thread {}: the memory from {address:#010x} on ({} bytes) is not what was loaded",
                    image.thread,
                    bytes.len()
                )));
            }
        }
        Ok(())
    }
}
