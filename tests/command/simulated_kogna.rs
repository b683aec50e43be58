//! The simulated Kogna: what its header and manual promise, as programs, scripts and machine files meet it. Nothing of it was
//! compared with a board.

use harness::{Output, Scratch, cc67, cc67_with_input};

const BOARD: [&str; 2] = ["--board", "kogna-5.3.2"];

/// The remark on every run.
const NOTE: &str = "cc67: the simulated Kogna is made from its header and manual, and was never compared with a board; \
                    times are those of a KFLOP\n";

/// A command in a folder with these files.
fn kogna(name: &str, files: &[(&str, &str)], command: &[&str], input: &str) -> Output {
    let scratch = Scratch::new(name);
    for (file, text) in files {
        scratch.write(file, text);
    }
    let (first, rest) = command.split_first().expect("a command");
    cc67_with_input(&scratch, [&[*first][..], &BOARD, rest].concat(), input)
}

/// The output of a program, and its remarks without that on every run.
fn run(name: &str, text: &str, more: &[&str]) -> (String, String) {
    let text = format!("#include \"KMotionDef.h\"\nmain()\n{{\n{text}\n}}\n");
    let output = kogna(name, &[("a.c", &text)], &[&["run", "a.c"], more].concat(), "");
    assert_eq!(output.code, 0, "{output:?}");
    assert!(output.stderr.contains(NOTE), "{}", output.stderr);
    (output.stdout, output.stderr.replacen(NOTE, "", 1))
}

/// Moves axis 12 and says where everything is.
const MOVE: &str = r#"    ch12->InputMode = NO_INPUT_MODE;
    ch12->OutputMode = NO_OUTPUT_MODE;
    ch12->Vel = 1000; ch12->Accel = 10000; ch12->Jerk = 100000;
    EnableAxisDest(12, 0);
    Move(12, 250);
    while (!CheckDone(12)) ;
    printf("%s", VersionAndBuildTime);
    printf("%.1f %.1f chan %x ch12 %x main %x\n", ch12->Dest, chan[12].Dest, (int)chan, (int)ch12, (int)main);
    printf("N %d board %s sizes %d %d\n", N_CHANNELS_KOGNA, BOARD, sizeof(chan), sizeof(ADC_BufferIn));"#;

#[test]
fn a_program_moves_axis_12_at_the_addresses_of_a_kogna() {
    let expect = "KOGNA 5.3.2 Build 18:10:31 Jan 31 2024\n250.0 250.0 chan 11832780 ch12 11833bc0 main ";
    for more in [&[][..], &["--engine", "bytecode"], &["--as", "board"]] {
        let (stdout, _) = run("simulated-kogna-move", MOVE, more);
        assert!(stdout.starts_with(expect), "{more:?}: {stdout}");
        assert!(stdout.contains(" main c0080"), "{more:?}: {stdout}");
        assert!(stdout.ends_with("N 16 board KOGNA sizes 6912 16\n"), "{more:?}: {stdout}");
    }
}

#[test]
fn images_in_both_forms_that_its_loader_takes_run() {
    let scratch = Scratch::new("simulated-kogna-images");
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\nmain()\n{{\n{MOVE}\n}}\n"));
    for form in ["coff", "elf"] {
        let built = cc67(&scratch, ["build", BOARD[0], BOARD[1], "--thread", "3", "--form", form, "a.c"]);
        assert_eq!(built.code, 0, "{built:?}");
        let output = cc67(&scratch, ["run", BOARD[0], BOARD[1], "3:a(3).out"]);
        assert!(output.stdout.contains("250.0 250.0 chan 11832780"), "{form}: {output:?}");
        assert!(output.stdout.contains(" main c0100"), "{form}: {output:?}");
        let refused = cc67(&scratch, ["run", "3:a(3).out"]);
        assert!(refused.stderr.contains("linked for KOGNA firmware 5.3.2"), "{form}: {refused:?}");
    }
    let of_kflop = cc67(&scratch, ["build", "--board", "kflop-5.3.2", "a.c"]);
    assert_ne!(of_kflop.code, 0, "a KFLOP has no `ch12`");
}

#[test]
fn bits_converters_and_timers_of_a_kogna_answer() {
    let (stdout, stderr) = run(
        "simulated-kogna-devices",
        r#"    SetBitDirection(203, 1);
    SetBit(203); SetBit(255); SetBit(275); SetBit(230);
    printf("%d %d %d %d", ReadBit(203), ReadBit(255), ReadBit(275), ReadBit(230));
    printf(" %d %d %x\n", GetBitDirection(203), GetBitDirection(204), BitDirShadowAUX2_EXIO);
    DAC(2, 100); KOGNA_DAC(5, -700);
    printf("%d %d\n", DAC_Buffer[2], Kogna_DAC_Buffer[5]);
    Delay_sec(0.01);
    printf("%d %d %d %d\n", ADC_BufferIn[3] - 2048, ADC_BufferIn[4] - 2048, ReadADC(3), Kogna_ADC_Buffer[1]);
    HRPWM_SetMode(1, 1); HRPWM_GPIO_SetDir(1, 1); HRPWM_GPIO_SetBit(1);
    SPI_SetMode(5, 2); SPI_GPIO_SetDir(0, 1); SPI_GPIO_ClearBit(0);
    printf("%d %d %d %d\n", HRPWM_GetMode(1), ReadBit(281), SPI_GetMode(5), SPI_GPIO_ReadBit(0));
    HRPWM0 = 1234; HRPWMPERIOD2 = 0x12345678; HRPWM_01_PRESCALE_POWER(3);
    printf("%d %x %x\n", HRPWM0, HRPWMPERIOD2, HRPWM_01_TIME_BASE_CTRL);
    { double begin = Time_sec(); unsigned int count = TIMER0;
      Delay_sec(0.01);
      printf("%d\n", (int)((TIMER0 - count) / 228e6 / (Time_sec() - begin) * 1000 + 0.5)); }
    printf("%d\n", FPGAW(0x05) == (FPGA32(0x04) >> 16));"#,
        &["--stim", "adc 3 = 1500", "--set", "board.kanalog=true"],
    );
    let expect = "1 1 1 0 1 0 8\n2148 1348\n1500 0 1500 0\n1 1 2 0\n1234 12345678 c00\n1000\n1\n";
    assert_eq!(stdout, expect, "{stderr}");
    assert!(stderr.contains("bit 230"), "{stderr}");
}

#[test]
fn seven_threads_run_in_their_spaces() {
    let scratch = Scratch::new("simulated-kogna-threads");
    let programs: Vec<String> = (1..=7).map(|thread| format!("{thread}:t{thread}.c")).collect();
    for thread in 1..=7 {
        let text = format!(
            "#include \"KMotionDef.h\"\nint own = {thread};\nmain() {{ int i; for (i = 0; i < 20; i++) \
             WaitNextTimeSlice(); persist.UserData[own] = (int)&own; MutexLock(&persist.UserData[20]); \
             printf(\"%d in %x\\n\", CurrentThread, (unsigned int)&own >> 16 & ~3); \
             MutexUnlock(&persist.UserData[20]); }}\n"
        );
        scratch.write(&format!("t{thread}.c"), &text);
    }
    let words: Vec<&str> =
        ["run", BOARD[0], BOARD[1]].into_iter().chain(programs.iter().map(|it| &**it)).collect();
    let output = cc67(&scratch, words);
    let mut lines: Vec<&str> = output.stdout.lines().collect();
    lines.sort_unstable();
    let expect = ["1 in c008", "2 in c00c", "3 in c010", "4 in c014", "5 in c018", "6 in c01c", "7 in c020"];
    assert_eq!(lines, expect, "{output:?}");
}

#[test]
fn commands_take_the_axes_and_channels_of_a_kogna() {
    let script = "Version\nOutputMode15=0\nInputMode15=0\nVel15=500\nEnableAxis15\nMoveAtVel15=40 500\nwait 1\nDest15\n\
                  CheckDone15\nEnableAxis16\nSetBitDirection 289 1\nGetBitDirection 289\nSetBit 289\nReadBit 289\n\
                  MasterAxis3=15\nMasterAxis3\nHRPWMSetMode2=1\nADC 11\nDAC 15 = 7\nGetIpAddr\nFlash\n";
    let output = kogna("simulated-kogna-commands", &[], &["console"], script);
    let replies = "KOGNA 5.3.2 Build 18:10:31 Jan 31 2024\n40\n1\nENABLEAXIS16\n            ^\n\
                   Error:Expecting value 0 to 15\n1\n1\n15\n0\nGETIPADDR\n^\nerror, invalid command\n";
    assert_eq!(output.stdout, replies, "{}", output.stderr);
    assert!(
        output.stderr.contains("GETIPADDR is not simulated: what a Kogna answers to it"),
        "{}",
        output.stderr
    );
    assert!(output.stderr.contains("flash memory of a Kogna is not simulated"), "{}", output.stderr);
    // On a KFLOP the same axis is refused.
    let scratch = Scratch::new("simulated-kogna-none");
    let output =
        cc67_with_input(&scratch, ["console", "--board", "kflop-5.3.2"], "EnableAxis15\nHRPWMSetMode2=1\n");
    assert!(output.stdout.contains("Error:Expecting value 0 to 7"), "{output:?}");
    assert!(output.stderr.contains("HRPWMSETMODE is a command of the Kogna board"), "{output:?}");
}

#[test]
fn commands_that_reach_outside_the_simulated_registers_and_memory_say_so() {
    let script = "FPGAW 320 1\nFPGA 4 0\nLoadData c13fffff 1\n55\nLoadData c1400000 1\n";
    let output = kogna("simulated-kogna-outside", &[], &["console"], script);
    assert_eq!(output.stdout, "invalid address\n", "{output:?}");
    let found: Vec<_> = output.stderr.lines().filter(|line| line.contains("FPGA register")).collect();
    assert!(
        matches!(found[..], [one] if one.contains("FPGA register 0x140 of a Kogna is not simulated")),
        "{found:?}"
    );
}

#[test]
fn the_status_record_has_all_axes_and_bits() {
    let script = "Pos12=5.5\nEnableAxis12\nSetBit 274\nGetStatus\n";
    let output = kogna("simulated-kogna-status", &[], &["console"], script);
    let words: Vec<u32> = output
        .stdout
        .split_whitespace()
        .map(|word| u32::from_str_radix(word, 16).unwrap_or_else(|_| panic!("{}", output.stdout)))
        .collect();
    assert_eq!((words[0], words.len()), (309 << 16 | 174, 174));
    let double = |at: usize| f64::from_bits(u64::from(words[at / 4]) | u64::from(words[at / 4 + 1]) << 32);
    assert_eq!((double(200 + 8 * 12), double(328 + 8 * 12)), (5.5, 5.5), "{words:x?}");
    assert_eq!((words[504 / 4], words[508 / 4]), (1 << 12, 1 << 12));
    assert_eq!(words[544 / 4], 1 << (274 - 264), "the state of bits 264 on");
}

#[test]
fn a_machine_file_describes_axis_12_and_bits_of_a_kogna() {
    let machine = "[axis.12]\nname = \"Turret\"\nunits = \"deg\"\n\n[[switch]]\nbit = 230\naxis = 12\nwhen = \">= 100\"\n";
    let program = format!(
        "#include \"KMotionDef.h\"\nmain()\n{{\n{}\n    printf(\"%d\", ReadBit(230)); Move(12, 50); \
         while (!CheckDone(12)) ; printf(\" %d\\n\", ReadBit(230));\n    Jog(12, 10);\n    Delay_sec(0.1);\n}}\n",
        MOVE.replace("NO_OUTPUT_MODE", "STEP_DIR_MODE; ch12->OutputChan0 = 12"),
    );
    let files = [("a.c", &*program), ("m.toml", machine)];
    let output = kogna(
        "simulated-kogna-machine",
        &files,
        &["run", "--machine", "m.toml", "--trace-items=dest12,load12", "--trace=t.csv", "a.c"],
        "",
    );
    assert!(output.stdout.ends_with("\n1 0\n"), "{output:?}");
    assert!(output.stderr.contains("step generator 12 of a Kogna are not simulated"), "{}", output.stderr);
    let scratch = Scratch::new("simulated-kogna-machine-kflop");
    scratch.write("a.c", "main() {}\n").write("m.toml", machine);
    let refused = cc67(&scratch, ["run", "--machine", "m.toml", "a.c"]);
    assert!(refused.stderr.contains("`12` is not an axis (0-7)"), "{}", refused.stderr);
    let refused = cc67(&scratch, ["run", "--trace-items=dest12", "--trace=t.csv", "a.c"]);
    assert!(refused.stderr.contains("known: dest0 to dest7"), "{}", refused.stderr);
}

#[test]
fn functions_and_memory_that_are_not_simulated_say_so() {
    for (call, expect) in [
        ("RS422_PutChar('a');", "RS422_PutChar is not simulated; the thread ends here"),
        ("DefineCoordSystem8P(8,9,10,-1,-1,-1,-1,-1);", "DefineCoordSystem8P is not simulated"),
        (
            "{ static unsigned char page[2048]; NandReadBlocks(100, 0, page, 2048); }",
            "NandReadBlocks is not simulated",
        ),
        ("FPGA(0x1a0) = 5;", "FPGA register 0x1a0 of a Kogna is not simulated"),
    ] {
        let (_, stderr) = run("simulated-kogna-refused", call, &[]);
        assert!(stderr.contains(expect), "{call}: {stderr}");
    }
    // Memory of a KFLOP is none of a Kogna, on every engine.
    for engine in ["bytecode", "native"] {
        for address in ["0x80200000", "0x10000100", "0x91000002", "0x90000000"] {
            let text = format!("main() {{ int *p = (int *){address}; *p = 1; }}\n");
            let output =
                kogna("simulated-kogna-wild", &[("a.c", &text)], &["run", "--engine", engine, "a.c"], "");
            let expect = format!("write of the unmapped address {address}");
            assert!(output.stderr.contains(&expect), "{engine}: {}", output.stderr);
        }
    }
    let files = [("a.c", "main() {}\n")];
    for (option, expect) in
        [("--races", "`--races`: accesses"), ("--flash=f.bin", "`--flash`: the flash memory")]
    {
        let output = kogna("simulated-kogna-options", &files, &["run", option, "a.c"], "");
        assert_eq!(output.code, 2, "{option}");
        assert!(output.stderr.contains(expect), "{option}: {}", output.stderr);
    }
}

#[test]
fn stimuli_and_the_debugger_know_sixteen_axes() {
    let program = format!("#include \"KMotionDef.h\"\nmain()\n{{\n{MOVE}\n}}\n");
    let files = [
        ("a.c", &*program),
        ("a.cmd", "catch when \"dest12 > 100\"\ncontinue\nprint dest12 > 100\nprint dest15\n"),
    ];
    let stimulus = [
        "--stim",
        "when axis 12 dest > 100 set bit 48\nat end expect axis 12 dest = 250\nat end expect dest12 = 250",
    ];
    let output = kogna("simulated-kogna-stimulus", &files, &[&["run", "a.c"][..], &stimulus].concat(), "");
    assert_eq!(output.code, 0, "{output:?}");
    let output = kogna("simulated-kogna-debugger", &files, &["debug", "-O0", "a.c", "--batch", "a.cmd"], "");
    assert!(output.stdout.contains("$1 = 1\n$2 = 0\n"), "{output:?}");

    let scratch = Scratch::new("simulated-kogna-axes");
    scratch.write("a.c", "main() {}\n");
    let output = cc67(&scratch, ["run", "a.c", "--stim", "at end expect axis 12 enabled"]);
    assert_eq!(output.code, 2, "{output:?}");
    assert!(output.stderr.contains("--stim:1:1: axis 12: the board has axes 0 to 7"), "{output:?}");
}
