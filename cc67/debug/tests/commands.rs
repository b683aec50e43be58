//! Commands of the debugger as a user types them, on small programs.

mod terminal;

use cc67_debug::CommandOutput;
use compiler::passes::Level;
use terminal::{Folder, check, shell};

const COUNTER: &str = "int parts, goal = 5;
int twice(int n)
{
    return n * 2;
}
main()
{
    int i;
    persist.UserData[10] = (int)&parts;
    for (i = 0; i < 8; i++)
    {
        parts = twice(i);
        printf(\"part %d\\n\", parts);
        WaitNextTimeSlice();
    }
}
";

const WRITER: &str = "main()
{
    int *p;
    while (!persist.UserData[10]) WaitNextTimeSlice();
    p = (int *)persist.UserData[10];
    Delay_sec(0.01);
    *p = 100;
    *p = 3;
}
";

#[test]
fn the_condition_of_a_watchpoint_is_in_the_words_of_where_it_was_set() {
    check(
        Level::None,
        &["int parts; main() { persist.UserData[10] = (int)&parts; for (;;) WaitNextTimeSlice(); }", WRITER],
        "watch parts if parts < 50
         continue",
        "Hardware watchpoint 1: parts
         Continuing.

         Hardware watchpoint 1: parts

         Old value = 100
         New value = 3
         Written by thread 2, main at b.c:9
         main () at b.c:10
         10	}",
    );
}

#[test]
fn a_stop_shows_what_was_printed_before_it() {
    check(
        Level::None,
        &[COUNTER],
        "break 15 if i == 2
         continue
         delete
         next
         reverse-next
         continue",
        "Breakpoint 1 at ADDRESS: file a.c, line 15.
         Continuing.
         part 0
         part 2
         part 4

         Breakpoint 1, main () at a.c:15
         15	        WaitNextTimeSlice();
         main () at a.c:11
         11	    for (i = 0; i < 8; i++)
         main () at a.c:15
         15	        WaitNextTimeSlice();
         Continuing.
         part 6
         part 8
         part 10
         part 12
         part 14
         [All threads have ended, 0.001620 s]",
    );
}

const TRAP: &str = "int *cursor, data[4];
int half(int n, int m)
{
    return m / n;
}
main()
{
    int i;
    char *text = \"text\";
    cursor = data;
    for (i = 5; i > 0; i--)
    {
        printf(\"%d: %d\\n\", i, half(i, 10));
        if (i == 2) cursor = (int *)0x12;
        *cursor = i;
    }
}
";

#[test]
fn what_was_printed_before_a_trap_comes_before_it() {
    check(
        Level::None,
        &[TRAP],
        "continue
         print *cursor
         print *cursor + 1
         x/2 cursor
         print (char *)cursor",
        "Continuing.
         5: 2
         4: 2
         3: 3
         2: 5
         Trap: thread 1 stopped at a.c:16:9 in `main`: write of the unmapped address 0x00000012
         ADDRESS in main () at a.c:16
         16	        *cursor = i;
         Cannot access memory at address 0x12
         Cannot access memory at address 0x12
         Cannot access memory at address 0x12
         $1 = 0x12 <error: Cannot access memory at address 0x12>",
    );
}

#[test]
fn values_are_those_of_the_board_and_of_c() {
    check(
        Level::None,
        &[TRAP],
        "break half
         continue
         print dest0
         print bit46
         print bit46 + 1
         print \"x\"
         print __LINE__
         backtrace
         info args
         up
         print __LINE__
         print i += 1
         print i++
         print i
         print i == 7
         print/x i - 20
         info locals",
        "Breakpoint 1 at ADDRESS: file a.c, line 5.
         Continuing.

         Breakpoint 1, half (n=5, m=10) at a.c:5
         5	    return m / n;
         $1 = 0
         $2 = 1
         $3 = 2
         $4 = \"x\"
         $5 = 5
         #0  half (n=5, m=10) at a.c:5
         #1  ADDRESS in main () at a.c:14
         n = 5
         m = 10
         #1  ADDRESS in main () at a.c:14
         14	        printf(\"%d: %d\\n\", i, half(i, 10));
         $6 = 14
         $7 = 6
         $8 = 6
         $9 = 7
         $10 = 1
         $11 = 0xfffffff3
         i = 7
         text = ADDRESS \"text\"",
    );
}

#[test]
fn hits_are_counted_as_gdb_counts_them() {
    check(
        Level::None,
        &[COUNTER],
        "watch parts
         continue
         continue 3
         ignore 1 1
         continue
         info breakpoints",
        "Hardware watchpoint 1: parts
         Continuing.
         part 0

         Hardware watchpoint 1: parts

         Old value = 0
         New value = 2
         Written by thread 1, main at a.c:13
         main () at a.c:14
         14	        printf(\"part %d\\n\", parts);
         Will ignore next 2 crossings of breakpoint 1.  Continuing.
         part 2
         part 4
         part 6

         Hardware watchpoint 1: parts

         Old value = 6
         New value = 8
         Written by thread 1, main at a.c:13
         main () at a.c:14
         14	        printf(\"part %d\\n\", parts);
         Will ignore next crossing of breakpoint 1.
         Continuing.
         part 8
         part 10

         Hardware watchpoint 1: parts

         Old value = 10
         New value = 12
         Written by thread 1, main at a.c:13
         main () at a.c:14
         14	        printf(\"part %d\\n\", parts);
         Num     Type           Disp Enb Address    What
         1       hw watchpoint  keep y              parts
         breakpoint already hit 6 times",
    );
}

#[test]
fn expressions_are_watched_whatever_they_are_read_from() {
    check(
        Level::None,
        &[
            "int a, b, *p = &a, row[3]; main() { a = 1; b = 5; p = &b; row[2] = 4; ClearBit(46); WaitNextTimeSlice(); b = 6; }",
        ],
        "watch *p + row[2]
         watch bit46 + 10
         watch 3
         continue
         continue
         continue
         continue
         continue",
        "Hardware watchpoint 1: *p + row[2]
         Hardware watchpoint 2: bit46 + 10
         Cannot watch constant value `3'.
         Continuing.

         Hardware watchpoint 1: *p + row[2]

         Old value = 0
         New value = 1
         Written by thread 1, main at a.c:2
         ADDRESS in main () at a.c:2
         2	int a, b, *p = &a, row[3]; main() { a = 1; b = 5; p = &b; row[2] = 4; ClearBit(46); WaitNextTimeSlice(); b = 6; }
         Continuing.

         Hardware watchpoint 1: *p + row[2]

         Old value = 1
         New value = 5
         Written by thread 1, main at a.c:2
         ADDRESS in main () at a.c:2
         2	int a, b, *p = &a, row[3]; main() { a = 1; b = 5; p = &b; row[2] = 4; ClearBit(46); WaitNextTimeSlice(); b = 6; }
         Continuing.

         Hardware watchpoint 1: *p + row[2]

         Old value = 5
         New value = 9
         Written by thread 1, main at a.c:2
         ADDRESS in main () at a.c:2
         2	int a, b, *p = &a, row[3]; main() { a = 1; b = 5; p = &b; row[2] = 4; ClearBit(46); WaitNextTimeSlice(); b = 6; }
         Continuing.

         Hardware watchpoint 2: bit46 + 10

         Old value = 11
         New value = 10
         Written by a program or the board in the last tick
         [0.000180 s]
         Continuing.

         Hardware watchpoint 1: *p + row[2]

         Old value = 9
         New value = 10
         Written by thread 1, main at a.c:2
         ADDRESS in main () at a.c:2
         2	int a, b, *p = &a, row[3]; main() { a = 1; b = 5; p = &b; row[2] = 4; ClearBit(46); WaitNextTimeSlice(); b = 6; }",
    );
}

#[test]
fn an_expression_is_caught_at_the_tick_in_which_it_becomes_true() {
    let text =
        "main() { ch0->Vel = 1000; ch0->Accel = 5000; ch0->Jerk = 50000; ch0->OutputMode = STEP_DIR_MODE;
        EnableAxisDest(0, 0); Move(0, 100); while (!CheckDone(0)) ; Move(0, 0); while (!CheckDone(0)) ; }";
    let folder = Folder::new();
    let mut first = shell(&folder, Level::Full, &[text]);
    let mut answer = |line: &str| match first.command(line, &mut |_| ()) {
        Ok(CommandOutput::Text(text)) => text,
        other => panic!("{line}: {other:?}"),
    };
    assert_eq!(answer("catch when \"ch0->Dest > 20\""), "Catchpoint 1 (when ch0->Dest > 20)\n");
    let stop = answer("continue");
    assert!(stop.starts_with("\nCatchpoint 1 (when ch0->Dest > 20)\n"), "{stop}");
    assert!(answer("print ch0->Dest > 20").ends_with("= 1\n"));
    // It becomes true again only after it was false.
    let caught = first.debugger().session().tick();
    let mut answer = |line: &str| match first.command(line, &mut |_| ()) {
        Ok(CommandOutput::Text(text)) => text,
        other => panic!("{line}: {other:?}"),
    };
    assert!(answer("continue").contains("All threads have ended"));
    assert!(answer("reverse-continue").starts_with("\nCatchpoint 1"));
    assert_eq!(first.debugger().session().tick(), caught);
    // In the previous tick, it is not.
    let folder = Folder::new();
    let mut second = shell(&folder, Level::Full, &[text]);
    let session = second.debugger().session();
    assert_eq!(session.read("ch0->Dest > 20"), Ok(0.0));
    let before = (caught.get() - 1) as f64 * kmotiondef::limits::TIMEBASE;
    let line = format!("goto {}", before + 1e-6);
    assert!(second.command(&line, &mut |_| ()).is_ok());
    assert!(second.debugger().session().tick() < caught);
    assert_eq!(second.debugger().session().read("ch0->Dest > 20"), Ok(0.0));
}

#[test]
fn words_of_gdb() {
    check(
        Level::None,
        &[COUNTER, WRITER],
        "break twice thread 1
         display/x parts
         commands 1
         print n + 100
         end
         continue
         display n
         continue
         undisplay 1
         finish
         thread apply all backtrace
         info threads
         jump 5
         delete
         commands",
        "Breakpoint 1 at ADDRESS: file a.c, line 5.
         1: /x parts = 0x0
         Continuing.

         Breakpoint 1, twice (n=0) at a.c:5
         5	    return n * 2;
         1: /x parts = 0x0
         $1 = 100
         2: n = 0
         Continuing.
         part 0

         Breakpoint 1, twice (n=1) at a.c:5
         5	    return n * 2;
         1: /x parts = 0x0
         2: n = 1
         $2 = 101
         Run till exit from #0  twice (n=1) at a.c:5
         ADDRESS in main () at a.c:13
         13	        parts = twice(i);
         Value returned is $3 = 2

         Thread 2:
         #0  ADDRESS in main () at b.c:7

         Thread 1:
         #0  ADDRESS in main () at a.c:13
         Id   State       Frame
         * 1    running     main () at a.c:13
         2    waiting     main () at b.c:7, waits for the time 0.010 s
         tick 4, 0.000360 s
         Undefined command: \"jump\".  Try \"help\".
         No breakpoints specified.",
    );
}

#[test]
fn a_breakpoint_may_be_at_the_calls_of_a_function_of_the_firmware() {
    check(
        Level::None,
        &["void off(void) { DisableAxis(1); } main() { DisableAxis(0); off(); }"],
        "break DisableAxis
         continue
         continue
         backtrace
         break EnableAxis",
        "Breakpoint 1 at ADDRESS: DisableAxis. (2 locations)  Before each call of DisableAxis.
         Continuing.

         Breakpoint 1, ADDRESS in main () at a.c:2
         2	void off(void) { DisableAxis(1); } main() { DisableAxis(0); off(); }
         Continuing.

         Breakpoint 1, ADDRESS in off () at a.c:2
         2	void off(void) { DisableAxis(1); } main() { DisableAxis(0); off(); }
         #0  ADDRESS in off () at a.c:2
         #1  ADDRESS in main () at a.c:2
         No program calls EnableAxis, which is the firmware's.",
    );
}

#[test]
fn a_breakpoint_on_a_line_with_an_inlined_call_stops_before_the_call() {
    check(
        Level::Full,
        &[COUNTER],
        "break 13
         continue
         print i
         print parts",
        "Breakpoint 1 at ADDRESS: file a.c, line 13.
         Continuing.

         Breakpoint 1, main () at a.c:13
         13	        parts = twice(i);
         $1 = 0
         $2 = 0",
    );
}
