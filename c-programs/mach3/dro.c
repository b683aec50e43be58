// cc67: run --set persist.6=10020 --set persist.20=d:12.5
//
// dro.c - numbers shared with Mach3 as doubles: reading a display and answering in another one.
//
//   cc67 run c-programs/mach3/dro.c --set persist.6=10020 --set persist.20=d:12.5
//
// Fifty doubles overlay the first hundred elements of persist: double n is in the
// elements 2n and 2n + 1. The PC copies some of them to its displays and back. A button
// on the screen sends a message number, which starts this program.
//
// Here the button takes the width of a part from double 10, and puts its middle into
// double 11. Expect 6.25, and the two elements in which it is stored.

#include "KMotionDef.h"

#define MESSAGE  6                  // persist: the number of the button
#define HALF     10020
#define WIDTH    10                 // a double
#define MIDDLE   11

double *Shared = (double *)persist.UserData;

main()
{
    switch (persist.UserData[MESSAGE])
    {
    case HALF:
        Shared[MIDDLE] = 0.5 * Shared[WIDTH];
        printf("middle %.2f, stored as %08x %08x\n", Shared[MIDDLE],
               persist.UserData[2 * MIDDLE], persist.UserData[2 * MIDDLE + 1]);
        break;
    default:
        printf("message %d is not known\n", persist.UserData[MESSAGE]);
    }
}
