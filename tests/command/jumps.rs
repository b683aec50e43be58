//! `setjmp` and `longjmp` where several things meet: threads, code of the host, object files.

use harness::{Scratch, cc67};

/// Marks a place for all threads to see and stays in the function.
const MARKS: &str = "\
#include \"KMotionDef.h\"
#include <setjmp.h>
main()
{
  if (setjmp((int *)gather_buffer) != 0) printf(\"back\\n\");
  persist.UserData[10] = 1;
  while (persist.UserData[10]) ;
}
";

/// Goes to it.
const JUMPS: &str = "\
#include \"KMotionDef.h\"
#include <setjmp.h>
main()
{
  while (!persist.UserData[10]) ;
  longjmp((int *)gather_buffer, 1);
}
";

#[test]
fn a_thread_does_not_jump_into_another() {
    let scratch = Scratch::new("jumps-threads");
    scratch.write("marks.c", MARKS).write("jumps.c", JUMPS);
    for engine in ["bytecode", "native"] {
        let output = cc67(&scratch, ["run", "--engine", engine, "--for", "0.1", "1:marks.c", "2:jumps.c"]);
        let expected = "thread 2 stopped at jumps.c:6:3 in `main`: `longjmp` to the buffer at 0x80102010, which another thread has set: each thread has its own stack";
        assert_eq!((output.code, output.stdout.as_str()), (3, ""), "{engine}");
        assert!(output.stderr.contains(expected), "{engine}: {}", output.stderr);
    }
}

#[test]
fn jumps_work_across_files() {
    let scratch = Scratch::new("jumps-files");
    scratch.write(
        "a.c",
        "#include <setjmp.h>\n#include <stdio.h>\njmp_buf place; void deep(int);\n\
         main() { int n = setjmp(place); if (n < 3) deep(n); printf(\"%d\\n\", n); }\n",
    );
    scratch.write(
        "b.c",
        "#include <setjmp.h>\nextern jmp_buf place;\nvoid deep(int n) { longjmp(place, n + 1); }\n",
    );
    for target in ["sim", "c67x"] {
        for file in ["a.c", "b.c"] {
            assert_eq!(cc67(&scratch, ["build", "-c", "--target", target, file]).code, 0, "{target} {file}");
        }
        let built = cc67(&scratch, ["build", "--target", target, "-o", "p.out", "a.o", "b.o"]);
        assert_eq!(built.code, 0, "{}", built.stderr);
        let output = cc67(&scratch, ["run", "p.out"]);
        assert_eq!((output.code, output.stdout.as_str()), (0, "3\n"), "{target}: {}", output.stderr);
    }
}
