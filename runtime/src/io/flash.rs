//! Flash memory: what survives power-off.
//!
//! The first megabyte is the system's. `Flash` saves the start state of the board there: on-chip memory with `persist`
//! and the settings of the axes, and the seven program spaces. The second megabyte is the users'; programs write its
//! blocks with `ProgramFlash` and read them directly. All of it is in guest memory, at [`FLASH`].

mod banks;

use std::ops::Range;

use chips::flash::{BLOCK, ERASED, USER};
use kmotiondef::map::{FLASH, IRAM, PROGRAM_BASE, PROGRAM_SIZE, program_base};
use kmotiondef::{GuestAddr, ThreadId};
use vm::memory::GuestMemory;

pub(crate) use banks::{BankRefused, Banks};

/// Bytes of flash memory, and of a file that holds it.
pub const FLASH_SIZE: usize = FLASH.size as usize;

/// The first bytes of the saved image; its layout is this simulator's own.
const MAGIC: &[u8; 16] = b"cc67 flash 1\n\0\0\0";
/// The offset of the ends of the seven program texts.
const TEXTS: u32 = 0x10;
/// The offset of on-chip memory.
const SAVED_IRAM: u32 = 0x1_0000;
/// The offset of the program spaces.
const SAVED_PROGRAMS: u32 = 0x8_0000;
/// Bytes of the program spaces.
const PROGRAMS: u32 = PROGRAM_SIZE * ThreadId::MAX as u32;
/// The limit of words that one call programs.
const WORD_LIMIT: i32 = 32_768;

const _: () = assert!(SAVED_IRAM + IRAM.size <= SAVED_PROGRAMS && SAVED_PROGRAMS + PROGRAMS <= USER);

/// A place in flash memory.
const fn flash_address(offset: u32) -> GuestAddr {
    FLASH.base.offset(offset)
}

/// Copies bytes inside of guest memory; both places are mapped.
fn copy(memory: &mut GuestMemory, to: GuestAddr, from: GuestAddr, length: u32) {
    let bytes = memory.read_bytes(from, length).map(<[u8]>::to_vec).unwrap_or_default();
    let stored = memory.poke_bytes(to, &bytes);
    debug_assert!(stored.is_ok(), "{to} is mapped");
}

/// Saves the start state of the board; `texts` are the texts of the loaded programs.
pub(crate) fn save(memory: &mut GuestMemory, texts: impl Fn(ThreadId) -> Option<Range<GuestAddr>>) {
    for (offset, byte) in (0..).zip(MAGIC) {
        memory.poke(flash_address(offset), *byte);
    }
    for (thread, offset) in ThreadId::all().zip((TEXTS..).step_by(4)) {
        memory.poke(flash_address(offset), texts(thread).map_or(0, |text| text.end.get()));
    }
    copy(memory, flash_address(SAVED_IRAM), IRAM.base, IRAM.size);
    copy(memory, flash_address(SAVED_PROGRAMS), GuestAddr::new(PROGRAM_BASE), PROGRAMS);
}

/// Returns whether flash holds a saved image.
pub(crate) fn is_saved(memory: &GuestMemory) -> bool {
    let begins_with_magic =
        || memory.read_bytes(FLASH.base, MAGIC.len() as u32).is_ok_and(|bytes| bytes == MAGIC);
    !memory.is_flash_erased() && begins_with_magic()
}

/// Restores the saved state.
pub(crate) fn restore(memory: &mut GuestMemory) {
    copy(memory, IRAM.base, flash_address(SAVED_IRAM), IRAM.size);
    copy(memory, GuestAddr::new(PROGRAM_BASE), flash_address(SAVED_PROGRAMS), PROGRAMS);
}

/// The text of a saved program.
pub(crate) fn text(memory: &GuestMemory, thread: ThreadId) -> Option<Range<GuestAddr>> {
    let end: u32 = memory.peek(flash_address(TEXTS + 4 * thread.index() as u32));
    let base = program_base(thread);
    (end > base.get() && end <= PROGRAM_BASE + PROGRAMS).then(|| base..GuestAddr::new(end))
}

/// Erases the block at `to` and programs it with 16-bit words; `false` if that is not a block of the users', or the
/// words are too many.
pub(crate) fn program(memory: &mut GuestMemory, to: GuestAddr, words: &[u8]) -> bool {
    let offset = to.get().wrapping_sub(FLASH.base.get());
    let is_users = (USER..FLASH.size).contains(&offset) && offset.is_multiple_of(BLOCK);
    if !is_users || words.len() > BLOCK as usize {
        return false;
    }
    let mut block = vec![ERASED; BLOCK as usize];
    block[..words.len()].copy_from_slice(words);
    memory.poke_bytes(to, &block).is_ok()
}

/// Bytes of this many words; `None` if a call does not take as many.
pub(crate) fn length(words: i32) -> Option<u32> {
    (0..=WORD_LIMIT).contains(&words).then_some(words.unsigned_abs() * 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_blocks_of_the_user_area_are_programmed() {
        let mut memory = GuestMemory::new();
        for (offset, expect) in
            [(0, false), (USER - BLOCK, false), (USER, true), (USER + 2, false), (USER + 15 * BLOCK, true)]
        {
            assert_eq!(program(&mut memory, flash_address(offset), &[1, 2, 3]), expect, "{offset:#x}");
        }
        assert_eq!(memory.peek::<u32>(flash_address(USER)), 0xFF03_0201);
        assert!(program(&mut memory, flash_address(USER), &[7]));
        assert_eq!(memory.peek::<u32>(flash_address(USER)), 0xFFFF_FF07);
        assert!(!program(&mut memory, flash_address(USER), &[0; BLOCK as usize + 1]));
        assert_eq!((length(-1), length(32_768), length(32_769)), (None, Some(65_536), None));
    }
}
