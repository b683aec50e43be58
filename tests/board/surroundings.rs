//! The machine around the board: encoders turned from outside, inputs controlled by a stimulus, amplifiers.

use harness::{Scratch, cc67};

/// Runs a program with a machine file and a stimulus; returns its console, and its remarks.
fn said(name: &str, program: &str, machine: &str, stimulus: &str) -> (String, String) {
    let scratch = Scratch::new(&format!("surroundings-{name}"));
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{program}"));
    scratch.write("m.toml", machine);
    scratch.write("s.stim", format!("{stimulus}\n"));
    let output = cc67(&scratch, ["run", "--machine", "m.toml", "--stim", "s.stim", "a.c"]);
    assert_eq!(output.code, 0, "{name}: {}", output.stderr);
    (output.stdout, output.stderr)
}

/// The console of a run without remarks.
fn shows(name: &str, program: &str, machine: &str, stimulus: &str) -> String {
    let (stdout, stderr) = said(name, program, machine, stimulus);
    assert_eq!(stderr, "", "{name}");
    stdout
}

#[test]
fn counts_of_an_encoder_are_scaled_once_whatever_describes_it() {
    const WHEEL: &str = "[[encoder]]\nchannel = 1\nmoves = [[0.1, -1000, 0.5]]\n";
    const TURNS: &str = "at 0.1s encoder 1 moves -1000 in 0.5s";
    let machines = [
        ("", TURNS),
        ("[axis.1]\nmodel = \"none\"", TURNS),
        ("[axis.1]\nencoder = true", TURNS),
        ("[axis.1]\nencoder = true\ncounts_per_unit = 20", TURNS),
        ("[axis.1]\nmodel = \"motor\"", TURNS),
        ("[axis.1]\nencoder = false", TURNS),
        (WHEEL, ""),
        (&format!("{WHEEL}[axis.1]\nmodel = \"none\""), ""),
    ];
    for gain in ["-1", "2", "0.5"] {
        let program = format!(
            "main() {{ ch1->InputMode = ENCODER_MODE; ch1->OutputMode = NO_OUTPUT_MODE; ch1->InputGain0 = {gain};\n\
             ch1->Position = 0; Delay_sec(0.7); printf(\"%g\\n\", ch1->Position); }}"
        );
        let expect = format!("{}\n", -1000.0 * gain.parse::<f64>().expect("a number"));
        for (machine, stimulus) in machines {
            assert_eq!(shows("gain", &program, machine, stimulus), expect, "{gain} {machine} {stimulus}");
        }
    }
}

/// A handwheel on encoder input 0, which axis 3 reads, moves a stepper on axis 0.
const HAND_WHEEL: &str = "
main()
{
    double last, way = 0;
    ch0->InputMode = INPUT;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 20000; ch0->Accel = 200000; ch0->Jerk = 4e6;
    EnableAxisDest(0, 0);
    ch3->InputMode = ENCODER_MODE;
    ch3->InputChan0 = 0;
    ch3->OutputMode = NO_OUTPUT_MODE;
    last = ch3->Position;
    while (Time_sec() < 1)
    {
        WaitNextTimeSlice();
        if (ch3->Position == last) continue;
        way += ch3->Position - last;
        last = ch3->Position;
        MoveExp(0, way, 0.02);
    }
    printf(\"%.0f %.0f\\n\", ch0->Dest, ch3->Position);
    DisableAxis(0);
}
";

#[test]
fn a_hand_wheel_has_the_input_of_a_stepper_without_an_encoder() {
    const TURNS: &str = "at 0.3s encoder 0 moves 100 in 0.5s";
    for mode in ["NO_INPUT_MODE", "ENCODER_MODE"] {
        let program = HAND_WHEEL.replace("INPUT;", &format!("{mode};"));
        for machine in
            ["", "[axis.0]\nmax = 8000", "[axis.0]\nencoder = false", "[axis.0]\nencoder = { input = 4 }"]
        {
            assert_eq!(shows("wheel", &program, machine, TURNS), "100 100\n", "{mode} {machine}");
        }
    }
}

#[test]
fn the_number_of_an_axis_names_its_encoder_where_no_axis_reads_that_input() {
    let program = "main() { ch3->InputMode = ENCODER_MODE; ch3->InputChan0 = 0; ch3->OutputMode = NO_OUTPUT_MODE;\n\
                   ch0->InputMode = NO_INPUT_MODE; Delay_sec(0.7); printf(\"%g\\n\", ch3->Position); }";
    let machine = "[axis.3]\nmodel = \"none\"\nencoder = { input = 0 }\n[axis.0]\nencoder = false\n";
    for number in [0, 3] {
        let stimulus = format!("at 0.1s encoder {number} moves 40 in 0.4s");
        assert_eq!(shows("axis-number", program, machine, &stimulus), "40\n", "encoder {number}");
    }
}

#[test]
fn an_encoder_that_a_hand_and_a_described_load_turn_is_reported() {
    let program = HAND_WHEEL.replace("INPUT;", "NO_INPUT_MODE;");
    let machine = "[axis.0]\nencoder = true";
    let (_, stderr) = said("twice", &program, machine, "at 0.3s encoder 0 moves 100 in 0.5s");
    let expect = "cc67: encoder 0 is turned by hand, and by the load of axis 0 as well, which the machine file connects \
                  to the same input: ";
    assert!(stderr.starts_with(expect), "{stderr}");
}

#[test]
fn a_turned_encoder_that_nothing_reads_is_reported() {
    let program = HAND_WHEEL.replace("INPUT;", "NO_INPUT_MODE;");
    let expect = "cc67: encoder 9 has been turned, but no axis reads its input, so nothing counts it: ";
    let wheel = "[[encoder]]\nchannel = 9\nmoves = [[0.3, 100, 0.5]]";
    for (machine, stimulus) in [("", "at 0.3s encoder 9 moves 100 in 0.5s"), (wheel, "")] {
        let (stdout, stderr) = said("unread", &program, machine, stimulus);
        assert_eq!(stdout, "0 0\n");
        assert!(stderr.starts_with(expect), "{stderr}");
    }
}

#[test]
fn a_stimulus_takes_an_analog_input_from_its_source() {
    let program = "main() { int level; Delay_sec(0.1); level = ADC(5); Delay_sec(0.5); printf(\"%d %d\\n\", level, ADC(5)); }";
    const EVENT: &str = "[[event]]\nat = 0.3\nadc = { 5 = 1620 }\n";
    for source in ["value = 1400", "sine = { mean = 1400, amp = 0, hz = 2 }"] {
        let machine = format!("[[adc]]\nchannel = 5\n{source}\n");
        for (machine, stimulus) in [(format!("{machine}{EVENT}"), ""), (machine, "at 0.3s adc 5 = 1620")] {
            let (stdout, stderr) = said("adc", program, &machine, stimulus);
            assert_eq!(stdout, "1400 1620\n", "{machine}");
            assert_eq!(
                stderr,
                "cc67: the stimulus overrides `[[adc]]` of the machine file on analog input 5 from now on\n"
            );
        }
    }
}

#[test]
fn a_bounce_and_a_pulse_give_the_input_back_to_its_switch() {
    let program = "
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 2000; ch0->Accel = 20000; ch0->Jerk = 4e5;
    EnableAxisDest(0, 0);
    Move(0, 3000);
    while (!CheckDone(0)) ;
    printf(\"%d\", ReadBit(136));
    Move(0, 0);
    while (!CheckDone(0)) ;
    printf(\"%d\\n\", ReadBit(136));
}
";
    let machine = "[[switch]]\nbit = 136\naxis = 0\nwhen = \">= 1500\"";
    for (action, expect, span) in [
        ("bounce bit 136 for 3ms", "10\n", " for 3 ms"),
        ("pulse bit 136 for 3ms", "10\n", " for 3 ms"),
        ("set bit 136", "11\n", ", until `release bit 136`"),
        // The stimulus already controls the input, and continues to: the bounce inverts its level.
        ("set bit 136; once axis 0 load > 1600 bounce bit 136 for 3ms", "00\n", ", until `release bit 136`"),
    ] {
        let stimulus = format!("once axis 0 load > 1500 {action}");
        let (stdout, stderr) = said("bounce", program, machine, &stimulus);
        assert_eq!(stdout, expect, "{action}");
        assert_eq!(
            stderr,
            format!("cc67: the stimulus overrides the switch of axis 0 on bit 136{span}\n"),
            "{action}"
        );
    }
}

#[test]
fn an_input_that_a_later_device_drives_is_not_left_open() {
    let program = "main() { int before; SetBitDirection(16, 1); before = ReadBit(23); SetBit(16); Delay_sec(0.2);\n\
                   printf(\"%d%d %d\\n\", before, ReadBit(23), ADC(2)); }";
    let stimulus = "at 0.1s device wire from=16 to=23; at 0.1s device rc high=16 adc=2";
    assert_eq!(shows("device", program, "", stimulus).get(..2), Some("01"));
}

/// A servo on a PWM channel of the board.
const BRIDGE: &str = "
main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->InputChan0 = 0;
    ch0->OutputChan0 = 0;
    ch0->MaxFollowingError = 1e6;
    EnableAxis(0);
    printf(\"%d\\n\", ch0->Enable);
}
";

#[test]
fn an_external_bridge_is_told_unless_the_machine_file_has_it() {
    const MOTOR: &str = "[axis.0]\nmodel = \"motor\"\n";
    for boards in ["[board]\nkanalog = true", "[board]\nsnapamp = 1"] {
        assert_eq!(shows("bridge", BRIDGE, &format!("{MOTOR}drive = {{ pwm = 0 }}\n{boards}"), ""), "1\n");
        let (_, stderr) = said("bridge", BRIDGE, &format!("{MOTOR}{boards}"), "");
        assert!(
            stderr.contains("EnableAxis: axis 0 drives PWM channel 0, where a KFLOP has no amplifier"),
            "{stderr}"
        );
    }
}

/// A servo that moves as far as it can.
const SERVO: &str = "
main()
{
    int i;
    WriteSnapAmp(SNAP0 + SNAP_PEAK_CUR_LIMIT0, LIMIT);
    WriteSnapAmp(SNAP0 + SNAP_PEAK_CUR_LIMIT1, LIMIT);
    Delay_sec(0.5);
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->InputChan0 = 0;
    ch0->OutputChan0 = 8;
    ch0->Vel = 30000; ch0->Accel = 200000; ch0->Jerk = 4e6;
    ch0->P = 0.25; ch0->I = 0.00003; ch0->D = 15; ch0->FFVel = 0.0023;
    ch0->MaxI = 100; ch0->MaxErr = 400; ch0->MaxOutput = 230; ch0->MaxFollowingError = 1000;
    EnableAxis(0);
    Jog(0, -8000);
    Delay_sec(1);
    Jog(0, 0);
    while (!CheckDone(0)) ;
    printf(\"%d\\n\", ch0->Dest - ch0->Position > 100);
}
";

#[test]
fn a_servo_that_still_settles_has_not_stayed_away() {
    let program = SERVO.replace("LIMIT)", "10)");
    let machine = "[board]\nsnapamp = 1\n[axis.0]\nmodel = \"motor\"";
    assert_eq!(shows("settles", &program, machine, ""), "1\n");
}

#[test]
fn the_cause_of_a_following_error_is_said_alone() {
    let limited = |limit: &str| SERVO.replace("LIMIT)", limit);
    for (program, keys, expect) in [
        (
            limited("8)"),
            "",
            "axis 0 does not follow its Dest because SnapAmp 0 holds its bridges off: the peak current limit of side A, 8, \
             is below 9 (2 A)\n",
        ),
        (
            limited("10)"),
            "min = -3000",
            "axis 0 runs into the end of its travel at -3000 (axis.0.min, m.toml:5): its motor pushes against the stop\n",
        ),
    ] {
        let machine = format!("[board]\nsnapamp = 1\n[axis.0]\nmodel = \"motor\"\n{keys}");
        let (stdout, stderr) = said("cause", &program, &machine, "");
        assert!(stdout.starts_with("Following Error Disabled Axis:0\n"), "{stdout}");
        assert!(stderr.ends_with(expect) && stderr.lines().count() == 1, "{stderr}");
    }
}
