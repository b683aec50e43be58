//@ says: SetBit(152): axis 1 is still on its way to the target of MoveXYZABC
//@ says: `while (!CheckDone(0));` waits for axis 0 alone, `while (!CheckDoneXYZABC());` for all
//@ says: path_of_which_one_axis_is_waited_for.c:28:5
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
    MoveXYZABC(500, 9000, 0, 0, 0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    SetBit(LASER);
    Delay_sec(0.2);
    ClearBit(LASER);
    while (!CheckDoneXYZABC()) WaitNextTimeSlice();
}
