//! Devices, as used by complete programs: encoders, step generators, PWM, option boards, the PC's files.

use std::fs;

use harness::{Output, Scratch, cc67, no_such_file, root};

/// Runs a program with options in its own folder, with further files.
fn run(name: &str, program: &str, files: &[(&str, &str)], options: &[&str]) -> (Output, Scratch) {
    let scratch = Scratch::new(&format!("devices-{name}"));
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{program}"));
    for (name, text) in files {
        scratch.write(name, text);
    }
    let arguments = ["run"].iter().chain(options).chain(&["a.c"]);
    (cc67(&scratch, arguments), scratch)
}

/// The console of a run that succeeds without other output.
fn shows(name: &str, program: &str, files: &[(&str, &str)], options: &[&str]) -> String {
    let (output, _) = run(name, program, files, options);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{name}: {}", output.stdout);
    output.stdout
}

/// The columns of a table written by a run.
fn table(scratch: &Scratch, name: &str) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(scratch.path().join(name)).expect("it is written");
    let row = |line: &str| line.split(',').filter_map(|cell| cell.parse().ok()).collect();
    text.lines().skip(1).map(row).collect()
}

#[test]
fn an_encoder_shows_its_phases_and_its_errors() {
    let program = "
main()
{
    int i;
    chan[1].InputMode = ENCODER_MODE;
    chan[1].OutputMode = NO_OUTPUT_MODE;
    for (i = 0; i < 5; i++)
    {
        Delay_sec(0.01);
        printf(\"%d%d \", ReadBit(2), ReadBit(3));
        Delay_sec(0.01);
    }
    FPGAW(ENC_NOISE_FILTER_ADD) = 7 + 0x200;
    printf(\"%d%d %d%d\\n\", ReadBit(2), ReadBit(3), ReadBit(18), ReadBit(19));
    printf(\"%02X\", FPGA(ENC_NOISE_ERR_ADD));
    FPGA(ENC_NOISE_ERR_ADD) = 0;
    printf(\" %02X\\n\", FPGA(ENC_NOISE_ERR_ADD));
}
";
    let stimulus =
        "every 20ms from 15ms until 75ms encoder 1 moves 1; at 95ms encoder 1 moves 3; encoder 1 fails";
    let (output, _) = run("encoder", program, &[], &["--stim", stimulus]);
    assert_eq!(output.stdout, "00 10 11 01 00 00 01\n20 00\n", "{}", output.stderr);
}

#[test]
fn an_encoder_wired_to_outputs_counts_the_edges_that_a_program_makes() {
    let program = "
main()
{
    int i;
    chan[3].InputMode = ENCODER_MODE;
    chan[3].OutputMode = NO_OUTPUT_MODE;
    SetBitDirection(30, 1);
    SetBitDirection(31, 1);
    for (i = 0; i < 100; i++)
    {
        SetBit(30); Delay_sec(2e-6); SetBit(31); Delay_sec(2e-6);
        ClearBit(30); Delay_sec(2e-6); ClearBit(31); Delay_sec(2e-6);
    }
    Delay_sec(0.001);
    printf(\"%.0f\\n\", chan[3].Position);
}
";
    let stimulus = "device quadrature a=30 b=31 axis=3";
    assert_eq!(shows("quadrature", program, &[], &["--stim", stimulus]), "400\n");
}

#[test]
fn a_device_responds_to_bits_set_and_read_through_registers() {
    // Select on bit 16, clock on 17, data on 18: the third group of eight.
    let program = "
#define GROUP 2
main()
{
    int i, Word = 0;
    FPGA(BIT_SET + GROUP) = 1;
    FPGA(BIT_CLR + GROUP) = ~2;
    FPGA(BIT_DIR + GROUP) = 3;
    FPGA(BIT_CLR + GROUP) = ~1;
    for (i = 0; i < 16; i++)
    {
        FPGA(BIT_SET + GROUP) = 2;
        Word = Word << 1 | (FPGA(BIT_READ + GROUP) >> 2 & 1);
        FPGA(BIT_CLR + GROUP) = ~2;
    }
    FPGA(BIT_SET + GROUP) = 1;
    printf(\"%04X\\n\", Word);
}
";
    let stimulus = "device spi select=16 clock=17 out=18 word=0xCA67";
    assert_eq!(shows("registers", program, &[], &["--stim", stimulus]), "CA67\n");
}

#[test]
fn a_step_generator_is_run_by_its_register() {
    // 3000 steps per second are 0x5E6 in units of 1.987.
    let program = "
void Rate(int Generator, int Rate)
{
    FPGA(STEP_RATE_ADD) = Rate;
    FPGA(STEP_RATE_ADD + 1) = Rate >> 8;
    FPGA(STEP_RATE_ADD + 2) = Rate >> 16;
    FPGA(STEP_RATE_ADD + 3) = 0x88 + Generator;
}
main()
{
    double T;
    chan[2].OutputMode = STEP_DIR_MODE;
    chan[2].OutputChan0 = 8 + 1;
    T = WaitNextTimeSlice();
    Rate(1, 0x5E6);
    while (Time_sec() < T + 0.05) WaitNextTimeSlice();
    Rate(1, 0);
    printf(\"%.0f %.1f\\n\", chan[2].Position, (short)FPGAW(STEP_POSITION_ADD1) / 128.0);
}
";
    let text = shows("rate", program, &[], &[]);
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(numbers.iter().all(|steps| (steps - 150.0).abs() <= 2.0), "{text}");
}

#[test]
fn an_axis_owns_the_pins_of_its_generator_and_its_register_counts() {
    let program = "
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    EnableAxisDest(0, 0.0);
    Delay_sec(0.001);
    ClearBit(8);
    printf(\"%d%d\", ReadBit(8), ReadBit(9));
    Move(0, -100.0);
    while (!CheckDone(0)) ;
    Delay_sec(0.001);
    printf(\" %d%d %.2f\", ReadBit(8), ReadBit(9), (short)FPGAW(STEP_POSITION_ADD0) / 128.0);
    FPGA(STEP_PULSE_LENGTH_ADD) = 32 + 0x80;
    printf(\" %d%d\\n\", ReadBit(8), ReadBit(9));
    DisableAxis(0);
}
";
    let options = ["--trace", "a.csv", "--trace-items", "step0,dest0", "--trace-bits", "b.csv"];
    let (output, scratch) = run("steps", program, &[], &options);
    assert_eq!((output.code, output.stdout.as_str()), (0, "11 10 -100.00 01\n"), "{}", output.stderr);
    assert_eq!(table(&scratch, "a.csv").last().map(|row| row[1]), Some(-100.0));
    let bits = fs::read_to_string(scratch.path().join("b.csv")).expect("it is written");
    let of_step = |bits: &str| bits.lines().filter(|line| line.split(',').nth(1) == Some("8")).count();
    assert_eq!(of_step(&bits), 0, "pulses that nobody requested: {bits}");
    let options = ["--trace-items", "bit8", "--trace-bits", "b.csv"];
    let (_, scratch) = run("pulses", program, &[], &options);
    let bits = fs::read_to_string(scratch.path().join("b.csv")).expect("it is written");
    assert_eq!(of_step(&bits) / 2, 101, "a hundred pulses, and the pin itself: {bits}");
}

#[test]
fn motors_of_a_kstep_need_its_enable_signal() {
    let program = "
main()
{
    int On;
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    SetBitDirection(45, 1);
    EnableAxisDest(0, 0.0);
    for (On = 0; On < 2; On++)
    {
        SetStateBit(45, On);
        MoveRel(0, 1000.0);
        while (!CheckDone(0)) ;
        Delay_sec(0.001);
        printf(\"%.0f of %.0f\\n\", ch0->Position, ch0->Dest);
    }
}
";
    let machine = "[board]\nkstep = true\nrespect_enable = true\n";
    let shown = shows("kstep", program, &[("k.toml", machine)], &["--machine", "k.toml"]);
    assert_eq!(shown, "0 of 1000\n1000 of 2000\n");
    assert_eq!(shows("kstep-not", program, &[], &[]), "1000 of 1000\n2000 of 2000\n");
}

#[test]
fn the_analog_output_of_a_kstep_can_be_traced() {
    let program = "
main()
{
    FPGA(KAN_TRIG_REG) = 4;
    FPGA(IO_PWMS_PRESCALE) = 46;
    FPGA(IO_PWMS) = 255;
    FPGA(IO_PWMS + 1) = 1;
    Delay_sec(0.2);
}
";
    let options = ["--trace", "a.csv", "--trace-items", "kstep_analog"];
    let (output, scratch) = run("kstep-analog", program, &[], &options);
    assert_eq!(output.code, 0, "{}", output.stderr);
    for row in table(&scratch, "a.csv") {
        // It begins within the first two ticks, with a time constant of 10 ms.
        let follows = |begun: f64| 1.0 - libm::exp(-(row[0] - begun).max(0.0) / 0.01);
        assert!((follows(0.0003)..=follows(0.0)).contains(&row[1]), "{row:?}");
    }
}

#[test]
fn a_low_pass_follows_a_pulse_width() {
    let program = "
main()
{
    int Duty;
    FPGA(IO_PWMS_PRESCALE) = 65;
    FPGA(IO_PWMS + 1) = 1;
    for (Duty = 0; Duty <= 255; Duty += 51)
    {
        FPGA(IO_PWMS) = Duty;
        Delay_sec(0.5);
        printf(\"%.2f\\n\", ADC(4) / 204.8);
    }
}
";
    let stimulus = "device rc high=26 adc=4 volts=5 ohms=1000 farads=50e-6";
    let shown = shows("low-pass", program, &[], &["--stim", stimulus]);
    for (line, volts) in shown.lines().zip(0..) {
        let found: f64 = line.parse().expect("a number");
        // A ripple of 986 Hz after a filter of 50 ms is at most 0.025 V.
        assert!((found - f64::from(volts)).abs() < 0.03, "{shown}");
    }
}

/// The program that generates a sine with two outputs of a Konnect board, the voltage that the board was given, and the
/// result; `name` is that of the test.
fn software_pwm(name: &str) -> Vec<Vec<f64>> {
    let scratch = Scratch::new(name);
    let folder = root().join("c-programs/konnect");
    let (stimulus, program) = (folder.join("software_pwm.stim"), folder.join("software_pwm.c"));
    let trace = scratch.path().join("a.csv");
    let arguments = [
        "run".as_ref(),
        "--stim".as_ref(),
        stimulus.as_os_str(),
        "--trace".as_ref(),
        trace.as_os_str(),
        "--trace-items=konnect8,adc0".as_ref(),
        program.as_os_str(),
    ];
    let output = cc67(&scratch, arguments);
    assert_eq!(output.code, 0, "{}", output.stderr);
    table(&scratch, "a.csv")
}

/// The circuit for that program: supply in volts, time constant in seconds, duration of a tick in seconds.
const SUPPLY: f64 = 11.23;
const CONSTANT: f64 = 100.0 * 290e-6;
const TICK: f64 = 90e-6;

#[test]
fn the_filter_matches_the_closed_form_of_a_low_pass() {
    let rows = software_pwm("devices-closed-form");
    let mut volts = 0.0;
    for pair in rows.windows(2) {
        // The input shows the voltage at the end of the previous tick.
        let counts = f64::round(volts * 204.8);
        assert!((pair[1][2] - counts).abs() <= 1.0, "{} for {counts} at {}", pair[1][2], pair[1][0]);
        let outputs = pair[0][1] as u32;
        let target = match (outputs >> 14 & 1, outputs >> 15 & 1) {
            (1, 0) => SUPPLY,
            (0, 1) => 0.0,
            _ => volts,
        };
        volts = target + (volts - target) * libm::exp(-TICK / CONSTANT);
    }
}

#[test]
fn the_filtered_sine_is_within_two_percent_of_the_wanted_one() {
    let rows = software_pwm("devices-sine");
    // Four whole periods of 5 Hz, after the capacitor is charged.
    let periods: Vec<_> = rows.iter().filter(|row| (0.2..1.0).contains(&row[0])).collect();
    let count = periods.len() as f64;
    let mean = |value: &dyn Fn(&[f64]) -> f64| periods.iter().map(|row| value(row)).sum::<f64>() / count;
    let volts = |row: &[f64]| row[2] / 204.8;
    let phase = |row: &[f64]| row[0] * 5.0 * std::f64::consts::TAU;
    let offset = mean(&volts);
    let sine = 2.0 * mean(&|row| volts(row) * libm::sin(phase(row)));
    let cosine = 2.0 * mean(&|row| volts(row) * libm::cos(phase(row)));
    let swing = sine.hypot(cosine);
    assert!((offset - 5.0).abs() < 0.02 * 3.0, "mean {offset}");
    assert!((swing - 3.0).abs() < 0.02 * 3.0, "amplitude {swing}");
    let fitted = |row: &[f64]| offset + sine * libm::sin(phase(row)) + cosine * libm::cos(phase(row));
    let worst = periods.iter().map(|row| (volts(row) - fitted(row)).abs()).fold(0.0, f64::max);
    assert!(worst < 0.02 * 3.0, "up to {worst} V beside it");
}

#[test]
fn only_konnect_boards_of_the_machine_file_are_present() {
    let program = "
main()
{
    InitAux();
    AddKonnect(0, &VirtualBits, VirtualBitsEx);
    AddKonnect(1, &VirtualBits, VirtualBitsEx + 1);
    Delay_sec(0.001);
    printf(\"%d %d\\n\", VirtualBitsEx[0], VirtualBitsEx[1]);
}
";
    let stimulus = "konnect 0 input 3 = 1; konnect 1 input 3 = 1";
    let options = ["--stim", stimulus, "--set", "board.konnect=[0]"];
    let (output, _) = run("konnect", program, &[], &options);
    assert_eq!((output.code, output.stdout.as_str()), (0, "8 0\n"));
    let told =
        "cc67: thread 1 at a.c:7:5 in `main`: AddKonnect(1, …): the machine has no board with that address\n";
    assert_eq!(output.stderr, told);
}

#[test]
fn a_snapamp_in_the_machine_has_idle_optos_and_bridges_that_fail() {
    let program = "
main()
{
    int k;
    printf(\"%d%d %d%d\\n\", ReadBit(72), ReadBit(79), ReadBit(104), ReadBit(111));
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->OutputChan0 = 8;
    ch0->MaxFollowingError = 1e9;
    for (k = 0; k < 2; k++)
    {
        EnableAxisDest(0, 0.0);
        MoveAtVel(0, 1000.0, 100000.0);
        Delay_sec(1.0);
        printf(\"%.0f\\n\", ch0->Position);
        DisableAxis(0);
        WriteSnapAmp(SNAP0 + SNAP_PEAK_CUR_LIMIT0, 9);
        WriteSnapAmp(SNAP0 + SNAP_PEAK_CUR_LIMIT1, 9);
        Delay_sec(0.3);
    }
}
";
    let machine = "[board]\nsnapamp = 1\n[inputs]\nhints = false\n";
    let shown = shows("snapamp", program, &[("s.toml", machine)], &["--machine", "s.toml"]);
    assert_eq!(shown, "11 00\n0\n1000\n");
}

#[test]
fn making_a_kanalog_pin_an_output_gives_a_warning() {
    let program = "main() { FPGA(KAN_TRIG_REG) = 1; SetBitDirection(16, 1); SetBitDirection(5, 1); SetBitDirection(6, 1); }";
    let (output, _) = run("jp7", program, &[], &[]);
    let told = "cc67: thread 1 at a.c:2:58 in `main`: bit 5 becomes an output, but Kanalog is connected to bits 0 to 15 of JP7\n";
    assert_eq!((output.code, output.stderr.as_str()), (0, told));
}

#[test]
fn outputs_of_a_missing_kanalog_are_reported_on_request() {
    let program = "main() { SetBit(152); SetBit(144); printf(\"%d%d\\n\", ReadBit(152), ReadBit(153)); }";
    let told = "cc67: bit 152 is an output of Kanalog, which is not switched on: the value is only stored \
                (`board.kanalog = true` in the machine file)\n";
    for (options, expect) in
        [(vec!["--verbose"], told), (vec![], ""), (vec!["--verbose", "--set", "board.kanalog=true"], "")]
    {
        let (output, _) = run("kanalog", program, &[], &options);
        assert_eq!((output.code, output.stdout.as_str(), output.stderr.as_str()), (0, "10\n", expect));
    }
}

#[test]
fn an_axis_commanded_to_step_too_fast_falls_behind() {
    let program = "
int Steps(void) { return (short)FPGAW(STEP_POSITION_ADD0) >> 7; }
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    FPGA(STEP_PULSE_LENGTH_ADD) = 63;
    EnableAxisDest(0, 0.0);
    WaitNextTimeSlice();
    ch0->Dest = 200.0;
    Delay_sec(0.001);
    printf(\"%d\", Steps() > 100 && Steps() < 150);
    Delay_sec(0.001);
    printf(\" %d\\n\", Steps());
    DisableAxis(0);
}
";
    let (output, _) = run("after", program, &[], &["-R", "no-dest-leaps"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "1 200\n"));
    let told = "cc67: thread 1 at a.c:9:5 in `main`: axis 0 needs more than 132275 steps per second, the most that pulses of 3.78 µs allow: it falls behind and catches up later: jog with fewer counts a second, or shorten the pulses (STEP_PULSE_LENGTH_ADD)\n";
    assert_eq!(output.stderr, told);
}

#[test]
fn the_flash_of_a_machine_file_is_kept() {
    let program = "main() { printf(\"%d\\n\", ++persist.UserData[7]); Delay_sec(0.01); }";
    let scratch = Scratch::new("devices-flash");
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{program}"));
    scratch.write("m/a.toml", "[board]\nflash = \"flash.bin\"\n[[event]]\nat = 0.005\ncommand = \"Flash\"\n");
    for expect in ["1", "2"] {
        let arguments = ["run", "--machine", "m/a.toml", "a.c"];
        let output = cc67(&scratch, arguments);
        assert_eq!((output.code, output.stdout.lines().next()), (0, Some(expect)), "{}", output.stderr);
    }
    assert!(scratch.path().join("m/flash.bin").exists());
}

#[test]
fn the_machine_file_names_the_serial_ports_files() {
    let program = "
main()
{
    char c;
    EnableRS232Cmds(RS232_BAUD_115200);
    DoRS232Cmds = FALSE;
    while ((c = RS232_GetChar()) != '.') RS232_PutChar(c + 1);
    Delay_sec(0.01);
}
";
    let machine = "[uart]\ninput = \"in.txt\"\noutput = \"out.txt\"\n";
    // Names are relative to the folder of the machine file.
    let files = [("m/a.toml", machine), ("m/in.txt", "HAL.")];
    let (output, scratch) = run("uart", program, &files, &["--machine", "m/a.toml"]);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""));
    assert_eq!(fs::read_to_string(scratch.path().join("m/out.txt")).expect("it is written"), "IBM");
}

#[test]
fn a_baud_rate_of_38400_delivers_100_characters_in_26_ms() {
    let program = "
main()
{
    int n = 0;
    double First = 0.0, Last = 0.0;
    SetBitDirection(45, 1);
    FPGA(KAN_TRIG_REG) = 2;
    FPGA(RS232_BAUD_REG) = RS232_BAUD_38400;
    while (n < 101)
    {
        if (!(FPGA(RS232_STATUS) & RS232_DATA_READY)) continue;
        FPGA(RS232_DATA);
        Last = Time_sec();
        if (n++ == 0) First = Last;
    }
    printf(\"%.4f\\n\", Last - First);
}
";
    let text = "x".repeat(101);
    let shown = shows("baud", program, &[("in.txt", &text)], &["--uart-input", "in.txt"]);
    let seconds: f64 = shown.trim().parse().expect("a number");
    // A character takes 0.26 ms.
    assert!((seconds - 0.0260).abs() <= 0.000_26, "{seconds}");
}

#[test]
fn a_program_that_reads_too_slowly_gets_the_first_and_last_character() {
    let program = "
main()
{
    int i;
    FPGA(KAN_TRIG_REG) = 2;
    FPGA(RS232_BAUD_REG) = RS232_BAUD_38400;
    while (!(FPGA(RS232_STATUS) & RS232_DATA_READY)) ;
    Delay_sec(0.01);
    for (i = 0; i < 3; i++)
    {
        int Ready = FPGA(RS232_STATUS) & RS232_DATA_READY;
        printf(\"%d%c\", Ready, Ready ? FPGA(RS232_DATA) : '-');
    }
    printf(\"\\n\");
}
";
    assert_eq!(shows("overrun", program, &[("in.txt", "abcde")], &["--uart-input", "in.txt"]), "1a1e0-\n");
}

#[test]
fn the_pc_answers_and_keeps_files_as_the_machine_file_says() {
    let program = "
int Ask(int Code)
{
    int Result;
    persist.UserData[PC_COMM_PERSIST] = Code;
    do { WaitNextTimeSlice(); } while ((Result = persist.UserData[PC_COMM_PERSIST]) > 0);
    return Result;
}
int Box(void)
{
    sprintf((char *)gather_buffer + 400, \"go on?\");
    persist.UserData[PC_COMM_PERSIST + 1] = 100;
    persist.UserData[PC_COMM_PERSIST + 2] = 4;
    Ask(PC_COMM_MSG);
    return persist.UserData[PC_COMM_PERSIST + 3];
}
main()
{
    FILE *f;
    double T;
    printf(\"%d\", Box());
    printf(\" %d\\n\", Box());
    f = fopen(\"c:\\\\Temp\\\\Log.txt\", \"wt\");
    fprintf(f, \"%d\\n\", 42);
    fclose(f);
    Delay_sec(0.1);
    T = Time_sec();
    f = fopen(\"log.txt\", \"rt\");
    printf(\"%s after %.2f s\\n\", f ? \"found\" : \"lost\", Time_sec() - T);
}
";
    let machine = "[host]
disk_root = \"pc\"
disk_latency_s = 0.05
files = { 'c:\\Temp\\Log.txt' = \"log.txt\" }
message_box = \"no\"

[[event]]
after = \"printed go\"
run = { thread = 2, program = \"never.c\" }

[[event]]
after = \"thread 1 started\"
host = { message_box = \"yes\" }
";
    let files = [("a.toml", machine), ("never.c", "main() { }")];
    let (output, scratch) = run("pc", program, &files, &["--machine", "a.toml"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "6 6\nfound after 0.05 s\n"), "{}", output.stderr);
    assert_eq!(fs::read_to_string(scratch.path().join("pc/log.txt")).expect("it is written"), "42\n");
}

#[test]
fn a_stimulus_loads_programs_and_runs_them() {
    let program =
        "main() { persist.UserData[5] = 1; Delay_sec(0.02); printf(\"%d\\n\", persist.UserData[5]); }";
    let files = [
        ("two.c", "#include \"KMotionDef.h\"\nmain() { persist.UserData[5] += 10; }"),
        (
            "three.c",
            "#include \"KMotionDef.h\"\nmain()\n{\n    int *p = 0;\n    persist.UserData[5] += 100;\n    *p = 1;\n}\n",
        ),
    ];
    let stimulus =
        "at 1ms run thread 2 \"two.c\"; at 3ms run thread 2 \"three.c\"; at 5ms run thread 2 \"two.c\"";
    let (output, _) = run("loads", program, &files, &["--stim", stimulus]);
    assert_eq!((output.code, output.stdout.as_str()), (3, "121\n"), "{}", output.stderr);
    assert!(output.stderr.contains("thread 2 stopped at three.c:6:5 in `main`"), "{}", output.stderr);
    let (output, _) = run("loads-wrong", program, &[], &["--stim", "run thread 2 \"gone.c\""]);
    assert_eq!((output.code, output.stderr), (2, format!("cc67: cannot read gone.c: {}\n", no_such_file())));
    let files = [("two.c", "main() { x = 1; }")];
    let (output, _) = run("loads-bad", program, &files, &["--stim", "run thread 2 \"two.c\""]);
    assert_eq!(output.code, 1, "{}", output.stderr);
}

#[test]
fn an_invalid_register_access_stops_only_the_thread() {
    for (access, expect) in [
        ("*(volatile short *)0x91000103 = 1;", "not aligned"),
        ("i = *(volatile int *)0x91000102;", "not aligned"),
        ("*(volatile char *)0x91001000 = 1;", "91001000"),
    ] {
        let program = format!("main() {{ int i; printf(\"on\\n\"); {access} printf(\"off %d\\n\", i); }}");
        let (output, _) = run("unaligned", &program, &[], &["-Wno-all"]);
        assert_eq!((output.code, output.stdout.as_str()), (3, "on\n"), "{access}: {}", output.stderr);
        assert!(output.stderr.contains(expect), "{access}: {}", output.stderr);
    }
}

#[test]
fn an_error_in_a_machine_file_gives_one_message_with_its_place() {
    for (text, expect) in [
        ("[board]\nkonnect = [0, 9]\n", "2:15: `board.konnect[1]` must be a whole number, 0 to 7, not 9"),
        ("[board]\nksetp = true\n", "2:1: unknown key `ksetp` in `board`; did you mean `kstep`?"),
        ("[uart]\ninput = 5\n", "2:9: `uart.input` must be a text in quotes, not 5"),
        (
            "[host]\nmessage_box = \"maybe\"\n",
            "2:15: `maybe` is not valid for `msgbox`: a button, such as `yes`",
        ),
        ("[[device]]\ntype = \"spi\"\n", "1:1: device `spi` needs `select=…`"),
        ("[[event]]\nat = 1\nhost = { box = \"ok\" }\n", "3:16: there is no answer `box`"),
        ("[uart\n", "1:6: "),
    ] {
        let (output, _) = run("wrong", "main() { }", &[("m.toml", text)], &["--machine", "m.toml"]);
        assert_eq!(output.code, 2, "{text}");
        let expect = format!("cc67: m.toml:{expect}");
        assert!(
            output.stderr.starts_with(&expect) && output.stderr.lines().count() == 1,
            "{}",
            output.stderr
        );
    }
    let options = ["--machine", "gone.toml"];
    let (output, _) = run("gone", "main() { }", &[], &options);
    assert_eq!(
        (output.code, output.stderr),
        (2, format!("cc67: cannot read gone.toml: {}\n", no_such_file()))
    );
    let options = ["--set", "uart.input=gone.txt"];
    let (output, _) = run("gone-input", "main() { }", &[], &options);
    assert_eq!(
        (output.code, output.stderr),
        (2, format!("cc67: cannot read gone.txt: {}\n", no_such_file()))
    );
}

#[test]
fn a_stimulus_moves_a_load_and_starts_and_stops_threads() {
    let program = "static int goes(void)\n{\n  int before = persist.UserData[5];\n  Delay_sec(0.05);\n\
                   return persist.UserData[5] != before;\n}\n\
                   main()\n{\n  ch0->InputMode = ENCODER_MODE;\n  printf(\"%d \", goes());\n  Delay_sec(0.2);\n\
                   printf(\"%.0f %d %d \", ch0->Position, ADC(0), goes());\n  Delay_sec(0.2);\n\
                   printf(\"%d\\n\", goes());\n}\n";
    let counter =
        "#include \"KMotionDef.h\"\nmain() { for (;;) { WaitNextTimeSlice(); persist.UserData[5]++; } }\n";
    let stimulus = "t=0.15 axis 0 push 950; adc 0 = follows axis 0 gain 2 offset 100\n\
                    t=0.2 start thread 2; t=0.4 stop thread 2; at end expect thread 2 ended\n\
                    t=0.3 start thread 5\n";
    let files = [("b.c", counter), ("s.stim", stimulus)];
    let (output, _) = run("threads", program, &files, &["--load", "2:b.c", "--stim", "s.stim"]);
    assert_eq!(output.stdout, "0 950 2000 1 0\n");
    assert_eq!((output.code, output.stderr.as_str()), (0, "cc67: s.stim:3:1: thread 5 holds no program\n"));
}

#[test]
fn a_condition_whose_level_was_there_from_the_beginning_is_explained() {
    let stimulus = "when bit 46 rises set bit 25; when bit 45 rises set bit 24";
    let (output, _) = run("level", "main() { Delay_sec(0.1); }", &[], &["--stim", stimulus]);
    let told = "cc67: never happened: --stim:1:1: when bit 46 rises (it was 1 all the time); \
                --stim:1:31: when bit 45 rises\n";
    assert_eq!((output.code, output.stderr.as_str()), (0, told));
}

#[test]
fn a_stimulus_that_plans_without_end_is_limited() {
    let stimulus = "every 90us toggle bit 24; when bit 24 changes after 1000s set bit 25";
    let (output, _) = run("plans", "main() { Delay_sec(10); }", &[], &["--stim", stimulus]);
    let told = "cc67: the stimulus has more than 100000 actions; later ones are left out\n\
                cc67: never happened: --stim:1:27: when bit 24 changes\n";
    assert_eq!((output.code, output.stderr.as_str()), (0, told));
}

#[test]
fn a_spindle_is_switched_by_two_bits() {
    let program = "static double speed(void)\n{\n  double before, t;\n  Delay_sec(0.5);\n\
                   before = chan[6].Position;\n  t = Time_sec();\n  Delay_sec(0.5);\n\
                   return (chan[6].Position - before) / 1000 / (Time_sec() - t);\n}\n\
                   main()\n{\n  chan[6].InputMode = ENCODER_MODE;\n  chan[6].InputChan0 = 6;\n\
                   SetBitDirection(154, 1);\n  SetBitDirection(155, 1);\n  printf(\"%.1f \", speed());\n\
                   SetBit(154);\n  printf(\"%.1f \", speed());\n  ClearBit(154);\n  SetBit(155);\n\
                   printf(\"%.1f \", speed());\n  SetBit(154);\n  printf(\"%.1f\\n\", speed());\n}\n";
    let machine = "[spindle]\naxis = 6\ncounts_per_rev = 1000\nbits = { cw = 154, ccw = 155 }\n\
                   full_scale_rps = 20\ntau_s = 0.05\n";
    // Ten time constants later it runs at full speed; with both bits it does not move.
    let options = ["--machine", "s.toml", "-R", "no-both-directions"];
    let shown = shows("spindle-bits", program, &[("s.toml", machine)], &options);
    assert_eq!(shown.replace("-0.0", "0.0"), "0.0 20.0 -20.0 0.0\n");
}

#[test]
fn a_switch_on_an_axis_that_drives_nothing_is_reported() {
    let program = "#include \"KMotionDef.h\"\nmain() { EnableAxis(2); Jog(2, 100); Jog(2, 0); Jog(3, 1); }";
    let machine = "[[switch]]\nbit = 12\naxis = 2\nwhen = \"<= -4000\"\n";
    let (output, _) = run("unmoved", program, &[("s.toml", machine)], &["--machine", "s.toml"]);
    let told = "cc67: thread 1 at a.c:3:25 in `main`: Jog: axis 2 drives nothing because its OutputMode is NO_OUTPUT_MODE, so the machine does not move (should an init program run first?)\n";
    assert_eq!(output.stderr.lines().next(), told.lines().next());
    assert_eq!(output.stderr.matches("drives nothing").count(), 1, "{}", output.stderr);
}
