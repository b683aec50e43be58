//! Actions of the PC: programs, commands, answers, values in `persist`, and characters on the serial port.

use std::sync::Arc;

use kmotiondef::ThreadId;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;

use crate::out::{Message, Request};
use crate::pc::Answers;
use crate::views::TypedAccess;
use crate::world::stimulus::reader::StatementReader;
use crate::world::stimulus::scene::Scene;
use crate::world::stimulus::tokens::Mistake;

pub(crate) fn read_uart(reader: &mut StatementReader<'_>) -> Result<(Vec<u8>,), Mistake> {
    Ok((reader.text()?,))
}

pub(crate) fn uart(scene: &mut Scene<'_, '_, '_>, bytes: Vec<u8>) {
    scene.access.io.uart.queue_bytes(&bytes, scene.context.now);
}

pub(crate) fn read_persist(reader: &mut StatementReader<'_>) -> Result<(usize, i32), Mistake> {
    let index = reader.persist()?;
    reader.expect_equals()?;
    Ok((index, reader.word32()?))
}

pub(crate) fn persist(scene: &mut Scene<'_, '_, '_>, index: usize, value: i32) {
    scene.context.memory.set(PERSIST.field(Persist::USER_DATA).element(index), value);
}

pub(crate) fn read_start(reader: &mut StatementReader<'_>) -> Result<(ThreadId,), Mistake> {
    Ok((reader.thread()?,))
}

pub(crate) fn start(scene: &mut Scene<'_, '_, '_>, thread: ThreadId) {
    if scene.context.threads.start(thread).is_err() {
        let message = Message::StimulusThreadEmpty { place: scene.place.to_string(), thread };
        scene.access.out.remark(scene.context.now, message);
    }
}

pub(crate) fn read_run(reader: &mut StatementReader<'_>) -> Result<(ThreadId, Arc<str>), Mistake> {
    let thread = reader.thread()?;
    Ok((thread, reader.string()?.into()))
}

pub(crate) fn run(scene: &mut Scene<'_, '_, '_>, thread: ThreadId, name: Arc<str>) {
    scene.access.out.ask(Request::Run(thread, name));
}

pub(crate) fn read_answer(reader: &mut StatementReader<'_>) -> Result<(String,), Mistake> {
    let column = reader.column();
    let setting = reader.string()?;
    let known = Answers::default().set(&setting);
    known.map_err(|error| (column, error.to_string()))?;
    Ok((setting,))
}

pub(crate) fn answer(scene: &mut Scene<'_, '_, '_>, setting: String) {
    let taken = scene.access.pc.host.answer_next(&setting);
    debug_assert!(taken.is_ok(), "it was checked when it was read");
}

pub(crate) fn read_command(reader: &mut StatementReader<'_>) -> Result<(String,), Mistake> {
    Ok((reader.string()?,))
}

/// Sends a command line, without an echo.
pub(crate) fn command(scene: &mut Scene<'_, '_, '_>, line: String) {
    scene.access.pc.usb.receive(format!("\u{1b}.{line}\r").as_bytes());
}

pub(crate) fn read_kill(reader: &mut StatementReader<'_>) -> Result<(ThreadId,), Mistake> {
    Ok((reader.thread()?,))
}

pub(crate) fn kill(scene: &mut Scene<'_, '_, '_>, thread: ThreadId) {
    scene.context.threads.pause(thread);
}
