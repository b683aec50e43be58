//@ args: --machine parts/spring.toml
//@ prints: 2 times
#include "KMotionDef.h"

main()
{
    int now, last = 0, changes = 0;
    double start;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 20000;
    ch0->Accel = 2e6;
    ch0->Jerk = 1e9;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    start = Time_sec();
    while (Time_sec() - start < 0.5)
    {
        now = ReadBit(136);
        if (now != last) changes++;
        last = now;
        WaitNextTimeSlice();
    }
    printf("%d times\n", changes);
}
