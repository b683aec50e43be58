//! Valid machine files, and the messages about invalid ones.

use kmotiondef::AxisId;

use super::*;

const FULL: &str = r#"
[axis.0]
name = "X"
model = "motor"
units = "mm"
counts_per_unit = 400.5
encoder = true
min = -10
max = 1_000
start = 5.5
ku = 2.5
tau_s = 0.03
friction = 1
inertia = 2
index = { bit = 36, every = 4096, width = 2, offset = 100 }

[axis.7]
model = "none"

[[switch]]
bit = 136
axis = 0
when = "<= -9"

[[switch]]
bit = 137
axis = 0
when = "between 1 2.5"
active = 0

[[probe]]
bit = 140
surface = { axis = 2, at = -5000 }
trips = "<="

[[encoder]]
channel = 3
moves = [[1.0, 40, 0.5], [3.0, -40, 0.2]]

[[adc]]
channel = 2
sine = { mean = 0, amp = 1000, hz = 2 }

[spindle]
axis = 6
counts_per_rev = 4096
driven_by = "axis 7"

[[wire]]
from = 8
to = 12
invert = true

[inputs]
idle_high = [130, "141-143"]
hints = false

[cpu]
servo_us = 30
bss_fill = 0xA5
strict_stack = true

[board]
kanalog = "auto"
snapamp = 0
"#;

#[test]
fn every_key_of_a_full_file_is_read() {
    let machine = MachineFile::parse(FULL).expect("a good file");
    let axis = &machine.axes[0];
    assert_eq!(
        (axis.model, axis.connection.encoder, axis.counts_per_unit),
        (Model::Motor, Encoder::Connected, 400.5)
    );
    assert_eq!((axis.travel.min, axis.travel.max, axis.travel.start), (-10.0, 1000.0, 5.5));
    assert_eq!((axis.motor.ku, axis.motor.inertia), (Some(2.5), 2.0));
    assert_eq!(axis.index.map(|index| index.every), Some(4096.0));
    assert_eq!(machine.axes[7].model, Model::None);
    assert_eq!(machine.connected.switches.len(), 2);
    assert!(
        machine.connected.switches[1].when == Condition::Between(1.0, 2.5)
            && !machine.connected.switches[1].active
    );
    assert_eq!(machine.connected.probes[0].touches, Condition::AtMost(-5000.0));
    assert_eq!(machine.connected.encoders[0].moves[1], [3.0, -40.0, 0.2]);
    assert_eq!(
        machine.connected.spindles.first().map(|spindle| spindle.drive),
        Some(SpindleDrive::Axis(AxisId::new(7).expect("7")))
    );
    assert_eq!(machine.idle_high.len(), 4);
    assert_eq!((machine.cpu.servo_us, machine.cpu.bss_fill, machine.hints), (Some(30.0), 0xA5, false));
}

#[test]
fn an_empty_file_gives_the_defaults() {
    assert_eq!(MachineFile::parse("").expect("a good file"), MachineFile::default());
}

#[test]
fn a_single_key_can_be_set() {
    let mut machine = MachineFile::default();
    for (key, value) in [("axis.0.model", "motor"), ("axis.0.tau_s", "0.5"), ("cpu.bss_fill", "7")] {
        machine.set(key, value).expect(key);
    }
    let axis = &machine.axes[0];
    assert_eq!((axis.model, axis.motor.tau_s, machine.cpu.bss_fill), (Model::Motor, 0.5, 7));
    assert!(machine.set("axis.0.model", "magic").is_err());
    assert_eq!(machine.axes[0].model, Model::Motor);
}

#[test]
fn boards_serial_port_and_pc_are_configured_by_keys() {
    let text = r#"
[board]
kstep = true
respect_enable = true
konnect = [0, 2]
konnect_aux0 = []
flash = "flash.bin"

[uart]
input = "in.txt"
output = ""

[host]
disk_root = "pc"
disk_latency_s = 0.05
files = { 'c:\Temp\Log.txt' = "log.txt" }
message_box = ["no", "yes"]
cells = { 5 = "1.25" }
answers = ["input=1.5", "dro.x=2"]
"#;
    let mut machine = MachineFile::parse(text).unwrap_or_else(|error| panic!("{}: {error}", error.line));
    assert!(machine.boards.has_kstep && machine.boards.respect_enable);
    assert_eq!(machine.boards.konnects, [0, 0b101]);
    assert_eq!((machine.uart.input.as_deref(), machine.uart.output.as_deref()), (Some("in.txt"), None));
    assert_eq!(machine.pc.disk_files, [("c:\\Temp\\Log.txt".to_owned(), "log.txt".to_owned())]);
    assert_eq!(machine.pc.disk_latency_s, 0.05);
    let mut answers = Answers::default();
    for setting in ["msgbox=no", "msgbox=yes", "cell.5=1.25", "input=1.5", "dro.x=2"] {
        answers.set(setting).expect(setting);
    }
    assert_eq!(machine.pc.answers, answers);
    machine.resolve_paths(Path::new("machines"));
    assert_eq!(
        machine.pc.disk_root.as_deref().map(Path::new),
        Some(Path::new("machines").join("pc").as_path())
    );
}

/// The message about a text, with line and column.
fn message(text: &str) -> String {
    let error = MachineFile::parse(text).expect_err(text);
    format!("{}:{}: {error}", error.line, error.column)
}

#[test]
fn mistakes_are_named_with_their_place() {
    for (text, expect) in [
        ("[axis.0]\nmodle = \"motor\"", "2:1: unknown key `modle` in `axis.0`; did you mean `model`?"),
        ("[axis.8]\nmodel = \"motor\"", "1:7: `8` is not an axis (0-7)"),
        (
            "[axis.0]\n  model = \"servo\"",
            "2:11: `axis.0.model` must be \"follow\" or \"motor\" or \"none\", not \"servo\"",
        ),
        ("[axis.0]\ntau_s = 0", "2:9: `axis.0.tau_s` must be a number above 0, not 0"),
        ("[axis.0]\nmin = nan", "2:7: `axis.0.min` must be a number, not nan"),
        ("[axis.0]\nmin = 3\nmax = 1", "1:1: `axis.0`: min 3 exceeds max 1"),
        ("[[switch]]\naxis = 0\nwhen = \">= 3\"", "1:1: `switch[0]` needs `bit`"),
        ("[[switch]]\nbit = 144", "2:7: `switch[0].bit` must be an input, not bit 144 (Kanalog opto out)"),
        ("[[switch]]\nbit = 5000", "2:7: `switch[0].bit` must be a bit number, 0 to 2047, not 5000"),
        (
            "[[switch]]\nwhen = \"< 3\"",
            "2:8: `switch[0].when` must be \"<= X\", \">= X\" or \"between X Y\", not \"< 3\"",
        ),
        (
            "[[encoder]]\nmoves = [[1, 2]]",
            "2:10: `encoder[0].moves[0]` must be [start in seconds, counts, duration in seconds], not a value of type array",
        ),
        (
            "[axis.0]\nmodel = \"motor\"\n[axis.1]\nencoder = { input = 0 }",
            "3:1: `axis.1`: encoder input 0 has the encoder of axis 0 already (that of a motor is on the input of its number, unless `encoder = { input = N }` says otherwise)",
        ),
        (
            "[[encoder]]\nchannel = 3\n[[encoder]]\nchannel = 3",
            "1:1: `encoder`: channel 3 has two tables; one of them has all its `moves`",
        ),
        (
            "[[axis]]\nkind = 1",
            "1:1: `axis` must be tables with a number, such as `[axis.0]`, not `[[axis]]`",
        ),
        ("[[board]]\nkonnect = []", "1:1: `board` must be one table, `[board]`, not `[[board]]`"),
        ("[cpu]\nservo_us = 95", "2:12: `cpu.servo_us` must be below the 90 µs of a tick, not 95"),
        ("[board]\nkonnect = [8]", "2:12: `board.konnect[0]` must be a whole number, 0 to 7, not 8"),
        (
            "[board]\nkonnect = 5",
            "2:11: `board.konnect` must be \"any\" or a list of addresses such as [0, 1], not 5",
        ),
        ("[uart]\ninput = 5", "2:9: `uart.input` must be a text in quotes, not 5"),
        ("[host]\nanswers = [\"input=x\"]", "2:12: `x` is not valid for `input`: a number"),
        ("switch = 5", "1:10: `switch` must be an array in [brackets], not 5"),
        ("[axis.0\nname = 5", "1:8: unclosed table, expected `]`"),
        (
            "colour = 5",
            "1:1: unknown key `colour`; known: axis, switch, probe, encoder, adc, wire, event, device, gantry, spindle, inputs, remarks, cpu, host, board, uart",
        ),
    ] {
        assert_eq!(message(text), expect, "{text}");
    }
}

#[test]
fn events_and_devices_become_stimulus_statements() {
    let text = "[[event]]
at = 2.5
set_bit = { 24 = 1 }
adc = { 0 = 1500 }
uart = \"G1 \\\"X\\\"\\r\"
encoder = { 3 = 25 }
disturb = { axis = 1, units = 50 }
command = \"StopImmediate0\"
run = { thread = 3, program = \"jog.c\" }
host = { message_box = \"no\", input = 1.5 }
encoder_error = 2
persist = { 10 = 7 }
kill = 2
[[event]]
after = \"printed go on\"
expect = { bit = { 46 = 1 }, printed = \"done\" }
[[device]]
type = \"echo\"
on = \"uart\"
[[device]]
type = \"spi\"
select = 16
clock = 17
out = 18
word = \"0x10,0x20\"
";
    let machine = MachineFile::parse(text).unwrap_or_else(|error| panic!("{}: {error}", error.line));
    // Keys are processed in alphabetical order.
    let expect = "at 2.5 adc 0 = 1500; at 2.5 command \"StopImmediate0\"; at 2.5 axis 1 push 50
at 2.5 encoder 3 moves 25; at 2.5 kill 2; at 2.5 persist 10 = 7; at 2.5 run thread 3 \"jog.c\"
at 2.5 answer \"input=1.5\"; at 2.5 answer \"message_box=no\"; at 2.5 encoder 2 fails
at 2.5 bit 24 = 1; at 2.5 uart \"G1 \\\"X\\\"\\r\"
once printed \"go on\" expect bit 46 = 1; once printed \"go on\" expect printed \"done\"
device echo; device spi clock=17 out=18 select=16 word=0x10,0x20
";
    let expect = Stimulus::parse(expect, "expected").unwrap_or_else(|error| panic!("{error}"));
    let meant = |stimulus: &Stimulus| -> Vec<String> {
        let mut rules: Vec<String> =
            stimulus.rules.iter().map(|rule| format!("{:?} {:?}", rule.trigger, rule.action)).collect();
        rules.sort();
        rules
    };
    assert_eq!(meant(&machine.stimulus), meant(&expect));
}

#[test]
fn wrong_events_are_named_with_their_place() {
    for (text, expect) in [
        (
            "[[event]]\nat = 1\nset_bit = { 46 = 1 }",
            "3:18: bit 46 (LED) is an output, only the board drives it",
        ),
        ("[[event]]\nat = -1", "2:6: `event[0].at` must be 0 or a positive number, not -1"),
        (
            "[[event]]\nafter = \"bit 46 blinks\"\nkill = 1",
            "3:8: expected `rises`, `falls`, `changes` or `= 1`, found `blinks`",
        ),
        ("[[event]]\nkil = 1", "2:1: unknown key `kil` in `event[0]`; did you mean `kill`?"),
        (
            "[[event]]\nrun = { thread = 8, program = \"jog.c\" }",
            "2:7: expected a thread from 1 to 7, found `8`",
        ),
        (
            "[[event]]\nhost = { message_box = \"maybe\" }",
            "2:24: `maybe` is not valid for `msgbox`: a button, such as `yes`",
        ),
        ("[[event]]\nencoder_error = 16", "2:17: expected an encoder input from 0 to 15, found `16`"),
        ("[[device]]\nfrom = 3", "1:1: `device[0]` needs `type`"),
        ("[[device]]\ntype = \"wire\"\nfrom = 3", "1:1: device `wire` needs `to=…`"),
    ] {
        assert_eq!(message(text), expect, "{text}");
    }
}
