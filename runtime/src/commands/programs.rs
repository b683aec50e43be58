//! Programs: downloading them word by word, and starting and stopping threads.

use kmotiondef::GuestAddr;
use kmotiondef::map::{FLASH, RegionKind};
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;

use super::arguments::Values;
use super::data::{Data, DataKind};
use super::session::{Answer, Session};
use crate::firmware::thread;
use crate::out::Message;
use crate::views::TypedAccess;

pub(super) fn execute(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (thread, context) = (values.thread(), &mut *session.context);
    if !thread::start(session.parts, context.memory, context.threads, thread) {
        session.parts.out.remark(context.now, Message::ExecuteEmpty { thread });
    }
    Answer::Nothing
}

pub(super) fn kill(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.context.threads.pause(values.thread());
    Answer::Nothing
}

pub(super) fn check_thread(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    i32::from(session.context.threads.state(values.thread()).is_active()).into()
}

pub(super) fn entry_point(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let place = PERSIST.field(Persist::ENTRY_POINTS).element(values.thread().index());
    session.memory().set(place, values.word(1));
    Answer::Nothing
}

/// Sets whether a thread starts at power-up.
pub(super) fn set_startup(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let place = PERSIST.field(Persist::RUN_ON_START_UP);
    let bit = 1 << values.integer(0);
    let bits = session.memory().get(place);
    let bits = if values.integer(1) == 0 { bits & !bit } else { bits | bit };
    session.memory().set(place, bits);
    Answer::Nothing
}

/// Takes data lines, unless the bytes would be outside memory, which the released firmware does not check.
pub(super) fn load_data(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (start, count) = (values.word(0), values.word(1));
    let end = u64::from(start) + u64::from(count);
    let memory = session.memory();
    let is_inside = memory.map().regions().any(|region| {
        let base = region.base.get();
        region.kind == RegionKind::Ram && start >= base && end <= u64::from(base) + u64::from(region.size)
    });
    // Of a Kogna's SDRAM only the first part is simulated.
    if !is_inside || memory.read_bytes(GuestAddr::new(start), count).is_err() {
        return Answer::Refused("invalid address");
    }
    data(DataKind::Program, start, count)
}

/// Takes the data lines of a new firmware and ignores them.
pub(super) fn load_flash(_: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (start, count) = (values.word(0), values.word(1));
    let end = u64::from(start) + u64::from(count);
    let limit = u64::from(FLASH.base.get()) + u64::from(FLASH.size);
    if start < FLASH.base.get() || end > limit {
        return Answer::Refused("invalid address");
    }
    data(DataKind::Firmware, start, count)
}

fn data(kind: DataKind, start: u32, count: u32) -> Answer {
    if count == 0 {
        return Answer::Nothing;
    }
    Answer::Data(Data::new(kind, GuestAddr::new(start), count as usize))
}
