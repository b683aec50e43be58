//@ args: --machine parts/home.toml --for 1
//@ says: thread 1 at jog_away_from_the_switch.c:18:9 in `main` waits for bit 12, but axis 0 moves away from its switch, which is active at ≤ -200: the axis is at 3966
//@ says: at the end, after 1.000 s of board time:
//@ says:   thread 1 at jog_away_from_the_switch.c:18:9 in `main` has waited since 0.000 s for bit 12 (now 0): its switch is 1 at ≤ -200, and axis 0 is at 3966.297
//@ says:   axis 0 (X): enabled, Dest 966.387, Position 0, moves at 1000 units/s
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, 1000);
    while (!ReadBit(12))
        WaitNextTimeSlice();
    Jog(0, 0);
}
