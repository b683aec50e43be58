//! Calls of functions from expressions: the board executes them while its time is stopped.

mod terminal;

use compiler::passes::Level;
use terminal::check;

const PROGRAM: &str = "int total, *nowhere = (int *)0x12;
double half(int n);
int add(int a, int b)
{
    total += a;
    return a + b;
}
int sum(int n)
{
    return n ? n + sum(n - 1) : 0;
}
main()
{
    int i, row[2];
    row[0] = 3; row[1] = 4;
    for (i = 0; i < 3; i++)
    {
        printf(\"%d\\n\", add(i, row[1]));
        Delay_sec(0.001);
    }
    later(2); half(3); sum(2); waits(); ends(); endless(); wild(); print_it(1); keep();
}
double half(int n) { return n / 2.0; }
float third(float x, double y) { return (x + y) / 3; }
int later(int n) { return 10 * n; }
int waits(void) { Delay_sec(1); return 1; }
void ends(void) { ThreadDone(); }
int endless(void) { for (;;) ; return 0; }
int wild(void) { total = 77; return *nowhere; }
void print_it(int n) { printf(\"it is %d\\n\", n); }
int keep(void) { return third(1, 2) + (int)&third; }
int unused(void) { return 1; }
";

#[test]
fn functions_of_the_program_are_called_and_the_board_stands() {
    check(
        Level::None,
        &[PROGRAM],
        "break 19 if i == 1
         continue
         print add(i, 2) * 10
         print total
         print sum(row[1]) + half(row[0])
         print/x later(3)
         print third(1.5, row[0])
         call print_it(7)
         print row[later(0)]
         set var total = sum(4)
         print total
         print n = 2
         backtrace
         continue",
        "Breakpoint 1 at ADDRESS: file a.c, line 19.
         Continuing.
         4

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         $1 = 30
         $2 = 1
         $3 = 11.5
         $4 = 0x1e
         $5 = 1.5
         it is 7
         $6 = 3
         $7 = 10
         No symbol \"n\" in current context.
         #0  main () at a.c:19
         Continuing.
         5
         6
         [All threads have ended, 1.003500 s]",
    );
}

#[test]
fn a_call_that_does_not_come_back_changes_nothing() {
    check(
        Level::None,
        &[PROGRAM],
        "break 19
         continue
         print wild()
         print total
         print waits()
         print ends()
         print endless()
         print printf(\"%d\", 3)
         print nothing(3)
         print unused()
         print sum(1, 2)
         break 20 if add(1, 1) == 2
         watch sum(3)
         display sum(3)
         print ReadBit(46)
         print Time_sec() > 1
         info threads",
        "Breakpoint 1 at ADDRESS: file a.c, line 19.
         Continuing.

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         `wild()`: wild at a.c:30: read of the unmapped address 0x00000012; nothing has changed
         $1 = 0
         `waits()`: the function waits at a.c:27, and the board stands meanwhile; nothing has changed
         `ends()`: the function ends its thread; nothing has changed
         `endless()`: the function has not returned after 1 s of the processor; nothing has changed
         `printf(\"%d\", 3)`: `printf` takes a variable number of arguments: an expression cannot call it
         `nothing(3)`: undefined function `nothing`; neither this program nor the firmware has it
         `unused()`: `unused` has no code of its own here: its calls are inlined, or it is not used; with -O0 it has some
         `sum(1, 2)`: too many arguments for `sum`; 2 given, 1 needed
         `add(1, 1) == 2`: an expression can call only fabs, sqrt, floor, ceil, sin, cos; `bit46` is the level of a bit
         `sum(3)`: an expression can call only fabs, sqrt, floor, ceil, sin, cos; `bit46` is the level of a bit
         `sum(3)`: an expression can call only fabs, sqrt, floor, ceil, sin, cos; `bit46` is the level of a bit
         $2 = 1
         $3 = 0
         Id   State       Frame
         * 1    running     main () at a.c:19
         tick 1, 0.000090 s",
    );
}

#[test]
fn a_call_of_a_function_without_code_says_so() {
    check(
        Level::Full,
        &[PROGRAM],
        "break 19
         continue
         print sum(4)
         print later(4)
         print half(4)
         print unused()",
        "Breakpoint 1 at ADDRESS: file a.c, line 19.
         Continuing.

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         $1 = 10
         $2 = 40
         $3 = 2
         `unused()`: `unused` has no code of its own here: its calls are inlined, or it is not used; with -O0 it has some",
    );
}

#[test]
fn the_past_ends_where_a_function_was_called() {
    check(
        Level::None,
        &[PROGRAM],
        "break 19
         continue
         continue
         reverse-continue
         print add(5, 0)
         continue
         print total
         reverse-continue
         print total",
        "Breakpoint 1 at ADDRESS: file a.c, line 19.
         Continuing.

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         Continuing.
         4

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         Continuing.

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         A new line of history begins here, at 0.000103 s; what came later is forgotten.
         $1 = 5
         Continuing.
         4

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         $2 = 5
         Continuing.

         Breakpoint 1, main () at a.c:19
         19	        printf(\"%d\\n\", add(i, row[1]));
         $3 = 5",
    );
}
