//! Every access to guest memory at its limits.

use kmotiondef::boards::TargetBoard;
use kmotiondef::map::{PROGRAM_BASE, TIMER0};
use proptest::prelude::*;

use super::*;

const SDRAM_BASE: u32 = SDRAM.base.get();
const IRAM_BASE: u32 = IRAM.base.get();
const FLASH_BASE: u32 = FLASH.base.get();

fn at(address: u32) -> GuestAddr {
    GuestAddr::new(address)
}

fn unmapped<T>(address: u32, access: Access) -> Result<T, TrapKind> {
    Err(TrapKind::Unmapped { addr: at(address), access })
}

#[test]
fn the_memory_of_another_board_is_where_its_map_says() {
    let kogna = TargetBoard::named("kogna-5.3.2").expect("the board is known");
    let mut memory = GuestMemory::new();
    memory.set_map(kogna.map());
    let (iram, sdram) = (at(0x1180_0000), at(0xc000_0000));
    for (first, last) in [(iram, iram.offset(0x3_fffc)), (sdram, sdram.offset(0x13f_fffc))] {
        assert_eq!((memory.store(first, 7_u32), memory.store(last, 8_u32)), (Ok(()), Ok(())));
        assert_eq!((memory.peek(first), memory.load(last)), (7_u32, Ok(8_u32)));
        assert_eq!(memory.load::<u8>(last.offset(4)), unmapped(last.get() + 4, Access::Read));
    }
    // The engines' fast access ends after 16 MiB; the rest is memory nevertheless.
    memory.poke(sdram.offset(0x100_0000), 5_u32);
    assert_eq!(memory.load::<u32>(sdram.offset(0x100_0000)), Ok(5));
    assert_eq!(memory.block::<4>(sdram.offset(0x100_0000)), Some(&[5, 0, 0, 0]));
    for foreign in [IRAM_BASE, SDRAM_BASE, FLASH_BASE] {
        assert_eq!(memory.load::<u32>(at(foreign)), unmapped(foreign, Access::Read));
        assert_eq!(memory.store(at(foreign), 9_u32), unmapped(foreign, Access::Write));
        assert_eq!(memory.load_ram::<u32>(at(foreign)), None);
        assert_eq!(memory.store_ram(at(foreign), 9_u32), None);
    }
    let text = kogna.program_base(ThreadId::new(2).expect("2 is a thread"));
    memory.protect(ThreadId::new(2).expect("2 is a thread"), text..text.offset(64));
    assert_eq!(memory.store(text.offset(8), 1_u32), Err(TrapKind::WriteProtected { addr: text.offset(8) }));
    assert!(memory.is_on_bus(at(0x6000_0040), Access::Write) && !memory.is_on_bus(TIMER0, Access::Read));
    let before = memory.snapshot();
    memory.poke(iram.offset(0x3_0000), 3_u32);
    memory.restore(&before);
    assert_eq!(memory.peek::<u32>(iram.offset(0x3_0000)), 0);
}

#[test]
fn each_region_ends_where_the_map_says() {
    let memory = GuestMemory::new();
    for (first, last) in [(IRAM_BASE, 0x1001_fffc), (SDRAM_BASE, 0x80ff_fffc), (FLASH_BASE, 0x901f_fffc)] {
        assert!(memory.load::<u32>(at(first)).is_ok() && memory.load::<u32>(at(last)).is_ok());
        assert_eq!(memory.load::<u32>(at(first - 4)), unmapped(first - 4, Access::Read));
        assert_eq!(memory.load::<u32>(at(last + 4)), unmapped(last + 4, Access::Read));
        assert_eq!(memory.read_bytes(at(last), 8), unmapped(last + 4, Access::Read));
    }
    assert_eq!(memory.load::<u32>(TIMER0), unmapped(TIMER0.get(), Access::Read));
}

#[test]
fn flash_is_erased_and_written_by_the_kernel_only() {
    let mut memory = GuestMemory::new();
    assert_eq!(memory.load::<u16>(at(FLASH_BASE + 2)), Ok(0xffff));
    assert_eq!(memory.store(at(FLASH_BASE), 1_u8), unmapped(FLASH_BASE, Access::Write));
    assert_eq!(memory.write_bytes(at(FLASH_BASE), &[1]), unmapped(FLASH_BASE, Access::Write));
    memory.poke(at(FLASH_BASE), 7_u8);
    assert_eq!(memory.load::<u16>(at(FLASH_BASE)), Ok(0xff07));
}

#[test]
fn alignment_is_checked_for_programs_and_not_for_the_kernel() {
    let mut memory = GuestMemory::new();
    let kind = |address, size, access| Some(TrapKind::Misaligned { addr: at(address), size, access });
    assert_eq!(memory.load::<u32>(at(SDRAM_BASE + 2)).err(), kind(SDRAM_BASE + 2, 4, Access::Read));
    assert_eq!(memory.load::<f64>(at(IRAM_BASE + 4)).err(), kind(IRAM_BASE + 4, 8, Access::Read));
    assert_eq!(memory.store(at(SDRAM_BASE + 1), 0_i16).err(), kind(SDRAM_BASE + 1, 2, Access::Write));
    assert_eq!(memory.store(at(SDRAM_BASE + 4), 0_i64).err(), kind(SDRAM_BASE + 4, 8, Access::Write));
    assert_eq!(memory.store(at(SDRAM_BASE + 4), 1.5_f64), Ok(()));
    assert_eq!(memory.peek::<f64>(at(SDRAM_BASE + 4)).to_bits(), 1.5_f64.to_bits());
    memory.poke(at(SDRAM_BASE + 1), 0x0102_0304_u32);
    assert_eq!(memory.peek::<u16>(at(SDRAM_BASE + 3)), 0x0102);
}

#[test]
fn with_board_faults_some_places_are_silent_and_low_bits_are_ignored() {
    let mut memory = GuestMemory::new();
    memory.set_faults(FaultPolicy::Board);
    assert_eq!(memory.load::<i32>(at(0)), Ok(0));
    assert_eq!(memory.load::<f64>(at(ROM_SIZE - 3)), Ok(0.0), "the last double of the ROM");
    assert_eq!(memory.load::<u8>(at(ROM_SIZE)), unmapped(ROM_SIZE, Access::Read));
    assert_eq!(memory.store(at(8), 7_u32).and_then(|()| memory.load::<u32>(at(8))), Ok(0));
    assert_eq!(memory.store(at(ROM_SIZE), 7_u32), unmapped(ROM_SIZE, Access::Write));
    assert_eq!(memory.fill(at(0), 1, ROM_SIZE), Ok(()));
    assert_eq!(memory.fill(at(0), 1, ROM_SIZE + 1), unmapped(ROM_SIZE, Access::Write));
    assert_eq!(memory.read_c_string(at(0), 80), Ok(Vec::new()));
    assert_eq!(memory.copy(at(SDRAM_BASE), at(0), 8), Ok(()));
    assert_eq!(memory.store(at(SDRAM_BASE + 6), 0x0102_0304_u32), Ok(()));
    assert_eq!(memory.peek::<u32>(at(SDRAM_BASE + 4)), 0x0102_0304);
    assert_eq!(memory.load::<i16>(at(SDRAM_BASE + 7)), Ok(0x0102));
    assert_eq!(memory.load::<u64>(at(SDRAM_BASE + 5)), Ok(0x0102_0304 << 32));
}

#[test]
fn with_board_faults_program_text_is_still_protected() {
    let mut memory = GuestMemory::new();
    memory.set_faults(FaultPolicy::Board);
    memory.protect(ThreadId::new(1).expect("1 is a thread"), at(PROGRAM_BASE)..at(PROGRAM_BASE + 32));
    let protected = Err(TrapKind::WriteProtected { addr: at(PROGRAM_BASE + 28) });
    assert_eq!(memory.store(at(PROGRAM_BASE + 30), 0_u32), protected);
}

#[test]
fn program_text_is_protected_from_programs() {
    let mut memory = GuestMemory::new();
    let thread = ThreadId::new(1).expect("1 is a thread");
    memory.protect(thread, at(PROGRAM_BASE)..at(PROGRAM_BASE + 32));
    let protected = Err(TrapKind::WriteProtected { addr: at(PROGRAM_BASE + 28) });
    assert_eq!(memory.store(at(PROGRAM_BASE + 28), 0_u32), protected);
    assert_eq!(memory.store(at(PROGRAM_BASE + 28), 0.0_f64), protected);
    assert_eq!(memory.write_bytes(at(PROGRAM_BASE + 28), &[0; 8]), protected);
    assert_eq!(memory.fill(at(PROGRAM_BASE + 28), 0, 8), protected);
    assert_eq!(memory.copy(at(PROGRAM_BASE + 28), at(SDRAM_BASE), 8), protected);
    assert_eq!(memory.store(at(PROGRAM_BASE + 32), 0_u32), Ok(()));
    assert_eq!(memory.poke_bytes(at(PROGRAM_BASE), &[1; 8]), Ok(()));
    memory.unprotect(thread);
    assert_eq!(memory.store(at(PROGRAM_BASE + 28), 0_u32), Ok(()));
}

#[test]
fn every_write_to_on_chip_ram_is_noticed() {
    let writes: &[fn(&mut GuestMemory, GuestAddr)] = &[
        |memory, to| assert_eq!(memory.store(to, 0_u8), Ok(())),
        |memory, to| memory.poke(to, 0_u64),
        |memory, to| assert_eq!(memory.write_bytes(to, &[0]), Ok(())),
        |memory, to| assert_eq!(memory.fill(to, 0, 1), Ok(())),
        |memory, to| assert_eq!(memory.copy(to, at(SDRAM_BASE), 1), Ok(())),
    ];
    let mut memory = GuestMemory::new();
    for write in writes {
        memory.take_touched();
        write(&mut memory, at(SDRAM_BASE + 64));
        memory.untouched(|memory| write(memory, at(IRAM_BASE)));
        assert!(!memory.take_touched());
        write(&mut memory, at(IRAM_BASE + 64));
        assert!(memory.take_touched() && !memory.take_touched());
    }
    assert!(memory.block_mut::<4>(at(IRAM_BASE)).is_some() && memory.take_touched());
}

#[test]
fn strings_end_at_their_zero_or_at_the_limit() {
    let mut memory = GuestMemory::new();
    memory.poke_bytes(at(0x80ff_fff8), b"abc\0wxyz").expect("it is mapped");
    assert_eq!(memory.read_c_string(at(0x80ff_fff8), 100), Ok(b"abc".to_vec()));
    assert_eq!(memory.read_c_string(at(0x80ff_fff8), 2), Ok(b"ab".to_vec()));
    assert_eq!(memory.read_c_string(at(0x80ff_fffc), 4), Ok(b"wxyz".to_vec()));
    assert_eq!(memory.read_c_string(at(0x80ff_fffc), 5), unmapped(0x8100_0000, Access::Read));
    assert_eq!(memory.read_c_string(GuestAddr::NULL, 5), unmapped(0, Access::Read));
}

#[test]
fn copies_may_overlap_and_cross_regions() {
    let mut memory = GuestMemory::new();
    memory.poke_bytes(at(SDRAM_BASE), b"12345678").expect("it is mapped");
    assert_eq!(memory.copy(at(SDRAM_BASE + 2), at(SDRAM_BASE), 6), Ok(()));
    assert_eq!(memory.read_bytes(at(SDRAM_BASE), 8), Ok(&b"12123456"[..]));
    assert_eq!(memory.copy(at(IRAM_BASE), at(SDRAM_BASE + 4), 4), Ok(()));
    assert_eq!(memory.read_bytes(at(IRAM_BASE), 4), Ok(&b"3456"[..]));
    assert_eq!(memory.copy(at(IRAM_BASE + 2), at(IRAM_BASE), 4), Ok(()));
    assert_eq!(memory.read_bytes(at(IRAM_BASE), 6), Ok(&b"343456"[..]));
    assert_eq!(memory.copy(GuestAddr::NULL, GuestAddr::NULL, 0), Ok(()));
    assert_eq!(memory.copy(GuestAddr::NULL, at(IRAM_BASE), 1), unmapped(0, Access::Write));
}

proptest! {
    #[test]
    fn accesses_agree_with_a_model_of_bytes(
        accesses in prop::collection::vec((0_u32..64, 0..4_u32, any::<u64>()), 1..50)
    ) {
        let mut memory = GuestMemory::new();
        let mut model = [0_u8; 64];
        for (offset, size, value) in accesses {
            let addr = at(0x8000_1000 + offset);
            let stored = match size {
                0 => memory.store(addr, value as u8),
                1 => memory.store(addr, value as u16),
                2 => memory.store(addr, value as u32),
                _ => memory.store(addr, value),
            };
            let (offset, size) = (offset as usize, 1 << size);
            prop_assert_eq!(stored.is_ok(), offset % size == 0);
            if stored.is_ok() {
                model[offset..offset + size].copy_from_slice(&value.to_le_bytes()[..size]);
            }
            prop_assert_eq!(memory.read_bytes(at(0x8000_1000), 64), Ok(&model[..]));
        }
    }
}
