//@ args: check
#include "KMotionDef.h"

#define TOOL 120

// A request by its number, 2, whose answer is waited for.
void Halt(void)
{
    persist.UserData[100] = 2;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}

main()
{
    persist.UserData[TOOL] = 3;
    printf("tool %d\n", persist.UserData[TOOL]);
    Halt();
}
