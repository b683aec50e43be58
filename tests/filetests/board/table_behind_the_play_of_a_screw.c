//@ args: --machine parts/backlash.toml
//@ prints: 1 1
#include "KMotionDef.h"

// The switch is at 100 of the table: the motor goes 10 further on the way up, and comes back to 90 before it opens.
double Find(double speed, int level)
{
    Jog(0, speed);
    while (ReadBit(136) != level) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    return ch0->Dest;
}

main()
{
    double up, down;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 1e6;
    ch0->Jerk = 1e8;
    EnableAxisDest(0, 0);
    up = Find(500, 1);
    down = Find(-500, 0);
    printf("%d %d\n", up >= 110 && up < 113, down <= 90 && down > 87);
}
