//@ prints: Following Error Disabled Axis:0
//@ prints: the axis is off
#include "KMotionDef.h"

main()
{
    ch0->InputMode = USER_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    ch0->MaxFollowingError = 50;
    EnableAxisDest(0, 0);
    Move(0, 2000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    if (CheckDone(0) < 0) printf("the axis is off\n");
}
