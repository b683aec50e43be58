//@ prints: arrived
//@ says: MoveRel: axis 0 moves by 2.5e-323 units, and never further
//@ says: distance_from_integer_halves.c:19:5
#include "KMotionDef.h"

main()
{
    union { double way; int words[2]; } received;

    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 20000;
    ch0->Accel = 200000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    received.words[0] = 5;
    received.words[1] = 0;
    MoveRel(0, received.way);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("arrived\n");
}
