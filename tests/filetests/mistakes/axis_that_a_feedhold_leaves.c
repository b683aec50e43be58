//@ args: --stim parts/door.stim
//@ prints: done
//@ says: thread 1 at axis_that_a_feedhold_leaves.c:32:13 in `main`: StopCoordinatedMotion: axis 2 is not in the coordinate system, so it goes on to -4000: name it in DefineCoordSystem, or stop it with Jog(2, 0)
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
    DefineCoordSystem(0, 1, -1, -1);
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
