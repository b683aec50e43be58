//! `Inject` and `GetInject`: the data for the PC's Bode screen, compared with those sent by the released firmware.

use cc67_host::Setup;
use runtime::{Event, EventKind};

/// An axis that holds its position: P = 2, Dest 100, Position 7. At this frequency the noise filter passes everything.
const COMMANDS: [&str; 7] = [
    "InputMode0=4",
    "OutputMode0=0",
    "P0=2",
    "EnableAxisDest0 100",
    "Pos0=7",
    "MaxFollowingError0=1e9",
    "Inject0 3536.776513 1",
];

/// The number of samples of a recording.
const SAMPLES: usize = 2048;

/// The first samples sent by the released firmware: stimulus, Position - Dest, Output, as bits of floats.
const FIRST: [[u32; 3]; 6] = [
    [0x3C63_41C0, 0xC2BA_0000, 0x433A_0000],
    [0xBEA6_074C, 0xC2BA_0000, 0x433A_071A],
    [0xBE43_F588, 0xC2BA_0000, 0x4339_59F9],
    [0x3D0D_7120, 0xC2BA_0000, 0x4339_9E05],
    [0x3EE5_2FCA, 0xC2BA_0000, 0x433A_11AE],
    [0xBEA8_1350, 0xC2BA_0000, 0x433A_E530],
];

/// The first samples of a second recording: its noise continues that of the first one.
const SECOND: [[u32; 3]; 2] =
    [[0x3C8C_A120, 0xC2BA_0000, 0x433A_0000], [0x3E3B_8578, 0xC2BA_0000, 0x433A_08CA]];

#[test]
fn an_injection_is_recorded_as_the_released_firmware_recorded_it() {
    let mut session = Setup::default().session().expect("a board");
    let mut numbers = Vec::new();
    let mut hear = |event: Event| {
        if let EventKind::Reply(line) = event.kind {
            let line = String::from_utf8_lossy(&line).into_owned();
            numbers.extend(line.split_whitespace().map(|word| u32::from_str_radix(word, 16).expect("hex")));
        }
    };
    for command in COMMANDS.iter().chain(&[COMMANDS[6]]) {
        session.exchange(command.as_bytes(), &mut hear);
        if command.starts_with("Inject") {
            let end = session.tick_after(0.4);
            session.advance(end, &mut hear);
            session.exchange(b"GetInject", &mut hear);
        }
    }
    assert_eq!(numbers.len(), 2 * SAMPLES * 3);
    let samples: Vec<&[u32]> = numbers.chunks(3).collect();
    assert_eq!(samples[..FIRST.len()], FIRST);
    assert_eq!(samples[SAMPLES..][..SECOND.len()], SECOND);
    for pair in samples[..SAMPLES].windows(2) {
        let [stimulus, output] = [pair[0][0], pair[1][2]].map(f32::from_bits);
        assert!((output - 2.0 * (93.0 + stimulus)).abs() < 1e-4, "{output} after {stimulus}");
    }
}
