// several_axes.c - a move of several axes keeps its kind also on an axis that was in motion; a single move does not.

#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 3; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = 8 + i;
        chan[i].Vel = 10000.0f;
        chan[i].Accel = 50000.0f;
        chan[i].Jerk = 1e6f;
        EnableAxisDest(i, 0.0);
    }
    DefineCoordSystem(0, 1, 2, -1);
    MoveAtVel(0, 1000.0, 500.0f);
    MoveAtVel(1, 1000.0, 500.0f);
    Delay_sec(0.1);
    MoveXYZABC(100.0, 200.0, 300.0, 0.0, 0.0, 0.0);
    printf("several: %d %d %d\n", chan[0].LastMotionType, chan[1].LastMotionType, chan[2].LastMotionType);
    Delay_sec(0.5);
    Move(0, 1000.0);
    Delay_sec(0.05);
    Move(0, 500.0);
    printf("one: %d\n", chan[0].LastMotionType);
    Delay_sec(0.5);
    printf("done at %.1f %.1f %.1f\n", chan[0].Dest, chan[1].Dest, chan[2].Dest);
}
