//! Faults of a link: no data are lost, the message is clear, and the next command works.

mod board;

use std::time::Duration;

use board::{Fault, KOGNA_VERSION, VERSION, board, program};
use cc67_wire::{Client, DiskAnswer, LoadImage, PcFiles, Queue, WireError};
use kmotiondef::ThreadId;

fn connect(fault: Fault) -> Client {
    Client::over(board(fault).0).expect("the board answers")
}

fn console(client: &mut Client) -> Vec<String> {
    client.settle(Duration::from_millis(60), Duration::from_secs(2)).expect("the link is there");
    client.take_console().iter().map(|line| String::from_utf8_lossy(line).into_owned()).collect()
}

fn load(client: &mut Client, image: &LoadImage) -> Result<(), WireError> {
    client.load(image, false, &mut |_| {})
}

/// Asserts that a board works normally.
fn is_in_order(client: &mut Client) {
    assert_eq!(client.ask("ReadBit46").expect("the board answers"), "1");
}

#[test]
fn garbage_before_the_handshake_is_dropped_and_whole_console_lines_are_kept() {
    let mut client = connect(Fault::Garbage);
    assert_eq!(client.version(), VERSION);
    assert_eq!(console(&mut client), ["whole line"]);
    is_in_order(&mut client);
}

#[test]
fn single_bytes_are_understood() {
    let mut client = connect(Fault::SingleBytes);
    is_in_order(&mut client);
    client.command("Echo hi").expect("the board answers");
    assert_eq!(console(&mut client), ["HI"]);
}

#[test]
fn a_board_that_answers_the_second_abort_byte_is_connected() {
    is_in_order(&mut connect(Fault::SilentOnce));
}

#[test]
fn a_kogna_that_answers_the_abort_byte_with_a_line_is_connected() {
    let mut client = connect(Fault::Kogna);
    assert_eq!(client.version(), KOGNA_VERSION);
    assert_eq!(console(&mut client), [""; 0]);
    is_in_order(&mut client);
    client.reconnect().expect("the board answers");
    assert_eq!(console(&mut client), [""; 0]);
}

#[test]
fn a_kogna_takes_programs_where_it_has_them_and_no_others() {
    let (link, state) = board(Fault::Kogna);
    let mut client = Client::over(link).expect("the board answers");
    let at = |start: u32| LoadImage {
        entry: start + 16,
        parts: vec![(start, vec![1; 100]), (0xC010_0000 - 4, vec![2; 8])],
        firmware: Some(KOGNA_VERSION.into()),
        ..program(0)
    };
    load(&mut client, &at(0xC00C_0000)).expect("it is the space of thread 2");
    assert_eq!(state.lock().expect("the state").memory.get(&0xC010_0003), Some(&2));
    for start in [0x8006_0000, 0xC008_0000, 0xC010_0000] {
        let message = load(&mut client, &at(start)).expect_err("it is elsewhere").to_string();
        assert!(message.contains("thread 2"), "{message}");
    }
}

#[test]
fn a_silent_board_is_reported_after_five_attempts() {
    let error = Client::over(board(Fault::Silent).0).expect_err("it does not answer");
    assert!(matches!(error, WireError::Silent { .. }), "{error}");
}

#[test]
fn a_lost_line_is_reported_and_the_next_is_answered() {
    let mut client = connect(Fault::LosesLine);
    let error = client.ask("ReadBit46").expect_err("the line is lost").to_string();
    assert_eq!(error, "fake: no answer to `ReadBit46` within 3 s");
    is_in_order(&mut client);
}

#[test]
fn a_refused_command_is_reported_at_once_in_the_boards_words() {
    let mut client = connect(Fault::None);
    let error = client.command("Bogus").expect_err("it is no command").to_string();
    assert_eq!(error, "the board refuses `Bogus`: error, invalid command");
    assert_eq!(console(&mut client), [""; 0]);
    is_in_order(&mut client);
}

#[test]
fn replies_to_another_client_are_not_taken_for_ours() {
    let mut client = connect(Fault::Replies);
    is_in_order(&mut client);
    assert_eq!(client.foreign_lines(), 1);
}

#[test]
fn a_load_arrives_whole_while_programs_print() {
    for fault in [Fault::None, Fault::Flood] {
        let (link, state) = board(fault);
        let mut client = Client::over(link).expect("the board answers");
        let image = program(20_000);
        load(&mut client, &image).expect("it is loaded");
        let memory = state.lock().expect("the state").memory.clone();
        for (address, bytes) in &image.parts {
            let stored: Vec<u8> =
                (*address..).map_while(|at| memory.get(&at).copied()).take(bytes.len()).collect();
            assert_eq!(&stored, bytes, "{fault:?}: part at {address:#x}");
        }
        let commands = state.lock().expect("the state").commands.clone();
        let order: Vec<&str> =
            commands.iter().map(|line| line.split(' ').next().unwrap_or_default()).collect();
        assert_eq!(order.first(), Some(&"VERSION"));
        assert!(order.ends_with(&["LOADDATA", "VERSION", "ENTRYPOINT2", "VERSION"]), "{order:?}");
        assert!(!order.contains(&"EXECUTE2"));
        is_in_order(&mut client);
        if fault == Fault::Flood {
            assert!(console(&mut client).iter().all(|line| line == "floods"));
        }
    }
}

/// Loads onto a board with a fault; returns the message. The thread cannot be started, and the link works unless it was
/// cut.
fn failed_load(fault: Fault) -> (String, Client) {
    let (link, state) = board(fault);
    let mut client = Client::over(link).expect("the board answers");
    let message = load(&mut client, &program(20_000)).expect_err("it is disturbed").to_string();
    let state = state.lock().expect("the state");
    assert!(!state.commands.iter().any(|command| command.starts_with("ENTRYPOINT")), "{fault:?}");
    let guard: Vec<u8> = (0x8006_0000..0x8006_0004).filter_map(|at| state.memory.get(&at).copied()).collect();
    assert!(guard.is_empty() || guard == [0; 4], "{fault:?}: the thread could be started: {guard:?}");
    drop(state);
    (message, client)
}

#[test]
fn a_cable_that_is_pulled_out_during_a_load_is_reported() {
    let (message, mut client) = failed_load(Fault::Unplug(20));
    assert!(message.contains("fake was disconnected during the download"), "{message}");
    assert!(message.contains("thread 2 cannot be started until a load succeeds"), "{message}");
    assert!(client.ask("ReadBit46").expect_err("the link is lost").is_disconnected());
}

#[test]
fn a_board_that_restarts_during_a_load_is_reported() {
    let (message, mut client) = failed_load(Fault::Reset(20));
    assert!(message.contains("the board restarted"), "{message}");
    is_in_order(&mut client);
    load(&mut client, &program(20_000)).expect("the next load succeeds");
}

#[test]
fn a_command_of_another_client_in_a_load_is_reported() {
    let (message, mut client) = failed_load(Fault::Foreign(20));
    assert!(message.contains("another program sent `CHECKDONE0` into the download"), "{message}");
    is_in_order(&mut client);
}

#[test]
fn nothing_is_sent_for_an_image_of_another_firmware_or_thread() {
    let (link, state) = board(Fault::None);
    let mut client = Client::over(link).expect("the board answers");
    let stale = LoadImage { firmware: Some("KFLOP 4.33 Build 10:00:00 Jan 1 2016".into()), ..program(100) };
    let message = load(&mut client, &stale).expect_err("it is refused").to_string();
    assert!(
        message.contains(VERSION) && message.contains("4.33") && message.contains("--force"),
        "{message}"
    );
    let other = LoadImage { thread: ThreadId::new(3).expect("there are 7"), ..program(100) };
    let message = load(&mut client, &other).expect_err("it is refused").to_string();
    assert!(message.contains("not for thread 3"), "{message}");
    assert_eq!(state.lock().expect("the state").commands, ["VERSION"]);
    client.load(&stale, true, &mut |_| {}).expect("it is forced");
}

#[test]
fn nothing_is_loaded_into_a_thread_that_does_not_stop() {
    let (link, state) = board(Fault::Unstoppable);
    let mut client = Client::over(link).expect("the board answers");
    let message = load(&mut client, &program(100)).expect_err("it runs").to_string();
    assert_eq!(message, "thread 2 does not stop: nothing was loaded");
    assert!(state.lock().expect("the state").memory.is_empty());
}

#[test]
fn files_of_programs_are_served_while_a_command_is_under_way() {
    struct OneLine;
    impl PcFiles for OneLine {
        fn request(&mut self, code: u8, text: &[u8]) -> Option<DiskAnswer> {
            assert_eq!((code, text), (4, &b"in.txt"[..]));
            Some(DiskAnswer::Line(b"hello".to_vec()))
        }
    }
    let (link, state) = board(Fault::None);
    let mut client = Client::over(link).expect("the board answers");
    client.serve_files(Box::new(OneLine));
    client.command("AskFile").expect("the board answers");
    is_in_order(&mut client);
    assert!(state.lock().expect("the state").commands.contains(&"READDISKDATA 1 5".to_owned()));
}

#[test]
fn several_users_of_a_board_take_turns() {
    let queue = Queue::new(connect(Fault::None), |client, _| drop(client.take_console()));
    let users: Vec<_> = (0..4)
        .map(|_| {
            let queue = queue.clone();
            std::thread::spawn(move || {
                for _ in 0..10 {
                    let answer = queue.run(Duration::from_secs(5), |client| client.ask("ReadBit46"));
                    assert_eq!(answer.expect("its turn comes").expect("the board answers"), "1");
                    let status = queue.run(Duration::from_secs(5), Client::status);
                    status.expect("its turn comes").expect("the board answers");
                }
            })
        })
        .collect();
    users.into_iter().for_each(|user| user.join().expect("its answers are right"));
}

#[test]
fn a_command_is_one_line() {
    let mut client = connect(Fault::None);
    for line in ["LoadData 80050000 4", "Version\rKill1", "Echo \x03"] {
        client.command(line).expect_err("it is refused");
    }
    is_in_order(&mut client);
}

#[test]
fn a_load_sends_little_more_than_its_bytes_and_seldom_waits() {
    let (link, state) = board(Fault::None);
    let mut client = Client::over(link).expect("the board answers");
    let image = LoadImage { parts: vec![(0x8006_0000, vec![0xA5; 1 << 16])], ..program(0) };
    let before = state.lock().expect("the state").received;
    load(&mut client, &image).expect("it is loaded");
    let state = state.lock().expect("the state");
    // Three characters for each byte; a full-speed chip moves 1 MB/s, and an answer takes 4 ms.
    let (needed, sent) = (3 * image.size(), state.received - before);
    let answers = state.commands.iter().filter(|command| *command == "VERSION").count();
    let (least, time) = (needed as f64 / 1e6, sent as f64 / 1e6 + 0.004 * answers as f64);
    assert!(time < 1.3 * least, "{sent} bytes and {answers} answers for {needed}");
}
