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
        "Temporary breakpoint 1 at ADDRESS: file a.c, line 9.
         Continuing.

         Temporary breakpoint 1, main () at a.c:9
         9	        other = i;
         Hardware read watchpoint 2: limit
         Hardware access (read/write) watchpoint 3: limit
         Hardware read watchpoint 4: row[2]
         Hardware read watchpoint 5: pair.y
         Expression cannot be implemented with read/access watchpoint.
         Expression cannot be implemented with read/access watchpoint.
         Num     Type            Disp Enb Address    What
         2       read watchpoint keep y              limit
         stop only if i >= 2
         3       acc watchpoint  keep y              limit
         4       read watchpoint keep y              row[2]
         5       read watchpoint keep y              pair.y
         Continuing.

         Hardware access (read/write) watchpoint 3: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         ADDRESS in main () at a.c:10
         10	        if (i == limit) other = 9;
         Continuing.

         Hardware access (read/write) watchpoint 3: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         ADDRESS in main () at a.c:10
         10	        if (i == limit) other = 9;
         No breakpoint number 1.
         Continuing.

         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         ADDRESS in main () at a.c:10
         10	        if (i == limit) other = 9;
         Continuing.

         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         ADDRESS in main () at a.c:10
         10	        if (i == limit) other = 9;
         Continuing.

         Hardware access (read/write) watchpoint 3: limit

         Old value = 3
         New value = 5
         Accessed by thread 1, main at a.c:13
         main () at a.c:14
         14	    limit = 5;
         Continuing.

         Hardware access (read/write) watchpoint 3: limit

         Value = 5
         Accessed by thread 1, main at a.c:14
         main () at a.c:15
         15	    copy = pair;
         Continuing.

         Hardware read watchpoint 5: pair.y

         Value = 0
         Accessed by thread 1, main at a.c:15
         main () at a.c:16
         16	    printf(\"%d\\n\", row[2]);
         Continuing.

         Hardware access (read/write) watchpoint 3: limit

         Value = 5
         Accessed by thread 1, main at a.c:14
         main () at a.c:15
         15	    copy = pair;
         Continuing.

         Hardware access (read/write) watchpoint 3: limit

         Old value = 3
         New value = 5
         Accessed by thread 1, main at a.c:13
         main () at a.c:14
         14	    limit = 5;
         Continuing.

         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         ADDRESS in main () at a.c:10
         10	        if (i == limit) other = 9;
         Continuing.

         Hardware read watchpoint 2: limit

         Value = 3
         Accessed by thread 1, main at a.c:10
         ADDRESS in main () at a.c:10
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
         Continuing.

         Hardware read watchpoint 1: flag

         Value = 0
         Accessed by thread 1, main at a.c:2
         ADDRESS in main () at a.c:2
         2	int flag; main() { persist.UserData[10] = (int)&flag; while (!flag) ; printf(\"on\\n\"); }
         Will ignore next 199 crossings of breakpoint 1.  Continuing.

         Hardware read watchpoint 1: flag

         Value = 0
         Accessed by thread 1, main at a.c:2
         ADDRESS in main () at a.c:2
         2	int flag; main() { persist.UserData[10] = (int)&flag; while (!flag) ; printf(\"on\\n\"); }
         Num     Type            Disp Enb Address    What
         1       read watchpoint keep y              flag
         breakpoint already hit 201 times
         Continuing.
         on
         [All threads have ended, 0.010530 s]",
    );
}
