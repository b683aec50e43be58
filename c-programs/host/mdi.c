// cc67: run --answer mdi=0
//
// mdi.c - a line of G code, requested by a program.
//
//   cc67 run --answer mdi=0 c-programs/host/mdi.c
//
// What G code does better than a program, such as moves in the units and offsets of the
// job, a program lets the PC do. The line is a text; the PC answers when it has been
// executed, or refuses while a job is running.
//
// The option above is the PC. Expect two lines, and both done.

#include "KMotionDef.h"
#include "pc.c"

void Gcode(char *Line)
{
    int Answer = AskText(PC_COMM_MDI, Line);

    printf("%s: %s\n", Line, Answer == 0 ? "done" : "refused");
}

main()
{
    Gcode("G0 Z10");
    Gcode("G0 X0 Y0");
}
