//! Watchpoints on reads.

mod terminal;

use compiler::passes::Level;
use terminal::check;

const PROGRAM: &str = "int limit = 3, other, row[4];
struct { int x, y; } pair, copy;
main()
{
    int i;
    for (i = 0; i < 4; i++)
    {
        other = i;
        if (i == limit) other = 9;
        row[i] = other;
    }
    limit = 5;
    limit = 5;
    copy = pair;
    printf(\"%d\\n\", row[2]);
}
";

#[test]
fn reads_stop_forwards_and_backwards() {
    check(
        Level::None,
        &[PROGRAM],
        "tbreak 9
         continue
         rwatch limit if i >= 2
         awatch limit
         rwatch row[2]
         rwatch pair.y
         rwatch i
         rwatch limit + 1
         info breakpoints
         disable 2
         continue
         continue
         disable 1
         enable 2
         continue
         continue
         continue
         continue
         continue
         reverse-continue
         reverse-continue
         reverse-continue
         reverse-continue",
        "Temporary breakpoint 1 at main, a.c:9 (thread 1)
         Breakpoint 1, main at a.c:9
         9	        other = i;
         Hardware read watchpoint 2: limit
         Hardware access (read/write) watchpoint 3: limit
         Hardware read watchpoint 4: row[2]
         Hardware read watchpoint 5: pair.y
         Expression cannot be implemented with read/access watchpoint.
         Expression cannot be implemented with read/access watchpoint.
         2    y read watchpoint  limit
         stop only if i >= 2
         3    y acc watchpoint  limit
         4    y read watchpoint  row[2]
         5    y read watchpoint  pair.y
         Hardware access (read/write) watchpoint 3: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         main at a.c:10
         10	        if (i == limit) other = 9;
         Hardware access (read/write) watchpoint 3: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         main at a.c:10
         10	        if (i == limit) other = 9;
         No breakpoint number 1.
         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         main at a.c:10
         10	        if (i == limit) other = 9;
         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         main at a.c:10
         10	        if (i == limit) other = 9;
         Hardware access (read/write) watchpoint 3: limit

         Old value = 3
         New value = 5
         Accessed by thread 1, main at a.c:13
         main at a.c:14
         14	    limit = 5;
         Hardware access (read/write) watchpoint 3: limit

         Value = 5
         Accessed by thread 1, main at a.c:14
         main at a.c:15
         15	    copy = pair;
         Hardware read watchpoint 5: pair.y

         Value = 0
         Accessed by thread 1, main at a.c:15
         main at a.c:16
         16	    printf(\"%d\\n\", row[2]);
         Hardware access (read/write) watchpoint 3: limit

         Value = 5
         Accessed by thread 1, main at a.c:14
         main at a.c:15
         15	    copy = pair;
         Hardware access (read/write) watchpoint 3: limit

         Old value = 3
         New value = 5
         Accessed by thread 1, main at a.c:13
         main at a.c:14
         14	    limit = 5;
         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         main at a.c:10
         10	        if (i == limit) other = 9;
         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         main at a.c:10
         10	        if (i == limit) other = 9;",
    );
}

#[test]
fn a_waiting_loop_that_reads_is_seen() {
    check(
        Level::Full,
        &[
            "int flag; main() { persist.UserData[10] = (int)&flag; while (!flag) ; printf(\"on\\n\"); }",
            "main() { Delay_sec(0.01); *(int *)persist.UserData[10] = 1; }",
        ],
        "rwatch flag
         continue
         continue 200
         info breakpoints
         disable
         continue",
        "Hardware read watchpoint 1: flag
         Hardware read watchpoint 1: flag

         Value = 0
         Accessed by thread 1, main at a.c:2
         main at a.c:2
         2	int flag; main() { persist.UserData[10] = (int)&flag; while (!flag) ; printf(\"on\\n\"); }
         Will ignore next 199 crossings of breakpoint 1.  Continuing.
         Hardware read watchpoint 1: flag

         Value = 0
         Accessed by thread 1, main at a.c:2
         main at a.c:2
         2	int flag; main() { persist.UserData[10] = (int)&flag; while (!flag) ; printf(\"on\\n\"); }
         1    y read watchpoint  flag
         breakpoint already hit 201 times
         on
         [All threads have ended, 0.010530 s]",
    );
}
