// cc67: run
//
// tool_table.c - reading and writing lengths in the tool table of the PC.
//
//   cc67 run c-programs/host/tool_table.c
//
// A request names the slot and the element of persist where the number should go, or
// come from. After a measurement a program writes the length of the tool, so that the next
// G43 uses it.
//
// Expect the length as it was written.

#include "KMotionDef.h"
#include "pc.c"

#define SLOT   4
#define LENGTH 20                   // a double in persist: elements 40 and 41

double *Length = &((double *)persist.UserData)[LENGTH];

int LengthOf(int Request, int Slot)
{
    persist.UserData[PARAMETER + 1] = LENGTH;
    return AskInt(Request, Slot);
}

main()
{
    *Length = 48.25;
    if (LengthOf(PC_COMM_SET_TOOLTABLE_LENGTH, SLOT) < 0) printf("the PC refuses\n");
    *Length = 0.0;
    if (LengthOf(PC_COMM_GET_TOOLTABLE_LENGTH, SLOT) < 0) printf("the PC refuses\n");
    printf("tool %d is %.2f long\n", SLOT, *Length);
}
