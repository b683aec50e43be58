//@ args: --stim ../mistakes/parts/door.stim
//@ prints: done
#include "KMotionDef.h"

void Setup(int axis)
{
    chan[axis].InputMode = NO_INPUT_MODE;
    chan[axis].OutputMode = STEP_DIR_MODE;
    chan[axis].OutputChan0 = axis;
    chan[axis].Vel = 2000;
    chan[axis].Accel = 20000;
    chan[axis].Jerk = 2e5;
    EnableAxisDest(axis, 0);
}

#define DOOR 136

main()
{
    Setup(0);
    Setup(1);
    Setup(2);
    DefineCoordSystem(0, 1, 2, -1);
    Move(0, 4000);
    Move(2, -4000);
    while (!CheckDone(0) || !CheckDone(2))
    {
        WaitNextTimeSlice();
        if (!ReadBit(DOOR))
        {
            StopCoordinatedMotion();
            while (!ReadBit(DOOR))
                WaitNextTimeSlice();
            ResumeCoordinatedMotion();
        }
    }
    printf("done\n");
}
