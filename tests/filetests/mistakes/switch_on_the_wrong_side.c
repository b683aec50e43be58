//@ args: --machine parts/wrong_side.toml
//@ says: thread 1 at switch_on_the_wrong_side.c:15:5 in `main`: Jog(0, 0): axis 0 has not moved since Jog(0, -4000): bit 136 was already as the program waited for: its switch is 1 at ≥ 0 (wrong_side.toml:6), and the axis is at 4000 (is the switch inverted, or at the other end?)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, -4000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
}
