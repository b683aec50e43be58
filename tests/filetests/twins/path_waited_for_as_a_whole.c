#include "KMotionDef.h"

#define LASER 152

void Setup(int axis)
{
    CHAN *ch = &chan[axis];
    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = STEP_DIR_MODE;
    ch->OutputChan0 = axis;
    ch->Vel = 5000;
    ch->Accel = 50000;
    ch->Jerk = 500000;
    EnableAxisDest(axis, 0);
}

main()
{
    SetBitDirection(LASER, 1);
    Setup(0);
    Setup(1);
    DefineCoordSystem(0, 1, -1, -1);
    MoveXYZABC(500, 5000, 0, 0, 0, 0);
    while (!CheckDoneXYZABC()) WaitNextTimeSlice();
    SetBit(LASER);
    Delay_sec(0.1);
    ClearBit(LASER);
    // An output that is switched on the way.
    MoveXYZABC(0, 0, 0, 0, 0, 0);
    Delay_sec(0.1);
    SetBit(LASER);
    // Each of them.
    while (!CheckDone(0) || !CheckDone(1)) WaitNextTimeSlice();
    ClearBit(LASER);
}
