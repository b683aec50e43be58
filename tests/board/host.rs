//! The host interface, as used by programs that embed a board.

use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use cc67_host::{Board, HostError, Lock};
use harness::Scratch;
use kmotiondef::structs::MainStatus;

const COUNTER: &str =
    "#include \"KMotionDef.h\"\nmain()\n{\n  for (;;) { WaitNextTimeSlice(); persist.UserData[9]++; }\n}\n";

/// A board that runs `source` in thread 1, and the folder of the source.
fn board(name: &str, source: &str) -> (Board, Scratch) {
    let scratch = Scratch::new(name);
    scratch.write("a.c", source);
    let mut board = Board::new();
    board.compile_and_load_coff(&scratch.path().join("a.c"), 1).expect("the program is right");
    board.write_line("Execute1").expect("it is connected");
    (board, scratch)
}

fn number(board: &mut Board, command: &str) -> i64 {
    board.write_line_read_line(command).expect("it answers").parse().expect("a number")
}

#[test]
fn a_program_that_does_not_compile_leaves_the_running_one_alone() {
    let (mut board, scratch) = board("host-compile", COUNTER);
    scratch.write("bad.c", "main()\n{\n  retrun 1;\n}\n");
    for length in [0, 1, 2, 10, 1000] {
        let before = number(&mut board, "GetPersistDec 9");
        let mut buffer = vec![0xff; length + 4];
        let (message, rest) = buffer.split_at_mut(length);
        let file = scratch.path().join("bad.c");
        assert_ne!(board.compile_and_load_coff_with_message(&file, 1, message), 0);
        assert_eq!(rest, [0xff; 4], "{length} bytes were too few");
        assert!(length == 0 || message.contains(&0), "the message in {length} bytes is not ended");
        if length == 1000 {
            let text = String::from_utf8_lossy(message.split(|byte| *byte == 0).next().expect("a piece"));
            assert!(text.contains("bad.c:3:"), "{text}");
        }
        assert_eq!(number(&mut board, "CheckThread1"), 1);
        assert!(number(&mut board, "GetPersistDec 9") > before, "the program does not run");
    }
    let mut message = [0xff; 8];
    let good = scratch.path().join("a.c");
    assert_eq!(board.compile_and_load_coff_with_message(&good, 2, &mut message), 0);
    assert_eq!(message[0], 0);
    assert_eq!(number(&mut board, "CheckThread2"), 0, "loading does not start");
    assert!(matches!(board.compile_and_load_coff(&good, 8), Err(HostError::Thread(8))));
    assert!(matches!(board.load_coff(1, &good), Err(HostError::Foreign { .. })), "a source is not an image");
}

#[test]
fn two_clients_in_two_threads_do_not_mix_their_exchanges() {
    let mut first = Board::new();
    first.write_line("SetGatherDec 0 1;SetGatherDec 8 2").expect("it is connected");
    let clients: Vec<_> = (0..2)
        .map(|number| {
            let mut client = first.another_client();
            thread::spawn(move || {
                for _ in 0..200 {
                    assert_eq!(client.wait_token(None), Lock::Locked);
                    client.write_line(&format!("GetGatherHex {} 9", number * 8)).expect("it is connected");
                    let line = client.read_line_timeout(100).expect("it answers");
                    client.read_line_timeout(100).expect("the ninth word is on a line of its own");
                    assert!(line.starts_with(&format!("{:08X} ", number + 1)), "{line}");
                    client.release_token();
                }
            })
        })
        .collect();
    for client in clients {
        client.join().expect("no exchange is mixed up");
    }
}

#[test]
fn a_client_that_dies_loses_the_token() {
    let mut first = Board::new();
    let mut second = first.another_client();
    let (sender, held) = mpsc::channel();
    let dying = thread::spawn(move || {
        assert_eq!(second.kmotion_lock(), Lock::Locked);
        sender.send(()).expect("it is awaited");
        thread::sleep(Duration::from_millis(20));
        // However a client ends, it is dropped.
        panic!("the client fails while it holds the token");
    });
    held.recv().expect("the token is taken");
    assert_eq!(first.kmotion_lock(), Lock::InUse);
    assert_eq!(first.service_console(), None);
    assert_eq!(first.wait_token(None), Lock::Locked);
    assert!(dying.join().is_err());
    assert!(first.write_line_read_line("Version").is_ok());
}

#[test]
fn a_reader_that_does_not_read_makes_the_program_wait() {
    let source =
        "#include \"KMotionDef.h\"\nmain()\n{\n  for (;;) printf(\"%d\\n\", persist.UserData[9]++);\n}\n";
    let (mut board, _scratch) = board("host-slow", source);
    board.run_for(5.0);
    let printed = number(&mut board, "GetPersistDec 9");
    board.run_for(5.0);
    assert_eq!(number(&mut board, "GetPersistDec 9"), printed, "the program goes on printing");
    // 1000 lines wait at the PC, 255 on the board, and one does not fit there. In the slice that fills the PC's list
    // the board sends as many lines as it has time for: 16 of four digits.
    assert!((1256..=1272).contains(&printed), "{printed}");
    for line in 0..100 {
        assert_eq!(board.service_console(), Some(line.to_string()));
    }
    board.run_for(1.0);
    let printed = number(&mut board, "GetPersistDec 9");
    assert!((1356..=1372).contains(&printed), "as many as were read: {printed}");
}

#[test]
fn replies_that_nobody_reads_take_limited_memory() -> Result<(), HostError> {
    let mut board = Board::new();
    let mut remarks = Vec::new();
    // Each reply is 1000 lines of 72 bytes.
    for _ in 0..40 {
        board.write_line("GetGatherHex 0 8000")?;
        board.run_for(1.0);
        remarks.extend(board.take_remark());
    }
    assert_eq!(remarks, ["1048576 bytes of replies have not been read; further replies are lost"]);
    // The first lines are still there.
    assert_eq!(board.read_line_timeout(0)?, ["00000000"; 8].join(" ") + "\r\n");
    Ok(())
}

#[test]
fn the_status_record_tells_what_programs_do() {
    let (mut board, _scratch) = board("host-status", COUNTER);
    board.write_line("EnableAxis0;Move0=1000;SetBit1024;SetPersistDec 103 77").expect("connected");
    let status = board.get_status().expect("it answers");
    assert_eq!(status.bytes().len(), 464);
    assert_eq!(status.get(MainStatus::VERSION_AND_SIZE), 0x0134_0074);
    assert_eq!(status.get(MainStatus::THREAD_ACTIVE), 0b11);
    assert_eq!(status.get(MainStatus::ENABLES), 1);
    assert_eq!(status.get(MainStatus::AXIS_DONE), 0);
    assert_eq!(status.get(MainStatus::VIRTUAL_BITS_EX0), 1);
    assert_eq!(status.get(MainStatus::PC_COMM.element(3)), 77);
    board.run_for(2.0);
    let later = board.get_status().expect("it answers");
    assert_eq!((later.get(MainStatus::AXIS_DONE), later.get(MainStatus::DEST.element(0))), (1, 1000.0));
    let passed = later.get(MainStatus::TIME_STAMP) - status.get(MainStatus::TIME_STAMP);
    assert!((2.0..2.02).contains(&passed), "{passed}");
}

/// Stores a double in two elements, low word first, as the PC application does.
fn set_double(board: &mut Board, element: u32, value: f64) {
    let bits = value.to_bits();
    for (element, word) in [(element, bits as u32), (element + 1, (bits >> 32) as u32)] {
        board.write_line(&format!("SetPersistHex {element} {word:X}")).expect("it is connected");
    }
}

#[test]
fn the_tap_cycle_of_the_manual_runs_from_a_scripted_host() {
    let mut board = Board::new();
    let file = harness::root().join("tests/board/inputs/rigid_tap.c");
    board.compile_and_load_coff(&file, 2).expect("the program is right");
    for axis in [6, 7] {
        let setup = format!(
            "OutputMode{axis}=0;InputMode{axis}=0;Vel{axis}=200000;Accel{axis}=2e6;Jerk{axis}=4e7;EnableAxisDest{axis} 0"
        );
        board.write_line(&setup).expect("it is connected");
    }
    // TPI, forward and retract RPM, depths in inches: total, forward and back per motion.
    let parameters = [20.0, 700.0, 1000.0, 0.75, 0.2, 0.05];
    for (index, parameter) in (0..).zip(parameters) {
        set_double(&mut board, 18 + 2 * index, parameter);
    }
    set_double(&mut board, 30, 0.0);
    board.write_line("SetPersistDec 6 10084;Execute2").expect("it is connected");
    let mut polls = 0;
    while board.write_line_read_line("GetPersistHex 31").expect("it answers") == "0" {
        board.run_for(0.05);
        polls += 1;
        assert!(polls < 1000, "the flag does not come");
    }
    assert_eq!(board.write_line_read_line("GetPersistHex 31").expect("it answers"), "3FF00000");
    assert_eq!(board.write_line_read_line("CheckThread2").expect("it answers"), "0");
    let lines: Vec<String> = std::iter::from_fn(|| board.service_console()).collect();
    let depths = ["0.200", "0.150", "0.350", "0.300", "0.500", "0.450", "0.650", "0.600", "0.750", "0.000"];
    let mut expect = vec!["Mach3 Notify Call, Message = 10084".to_owned()];
    expect.extend(depths.map(|depth| format!("depth {depth}")));
    expect.push("Tap Complete".to_owned());
    assert_eq!(lines, expect);
    let back: f64 = board.write_line_read_line("Dest7").expect("it answers").parse().expect("a number");
    assert!(back.abs() < 1.0, "{back}");
}
