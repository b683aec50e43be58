//@ args: --machine parts/at_its_switch.toml
//@ says: Jog(0, 300): axis 0 has not moved since Jog(0, -3000): bit 136 was already as the program waited for
//@ says: an axis begins at `start` in the machine file, 0 without it
//@ says: homing_that_begins_on_the_switch.c:17:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 500000;
    EnableAxisDest(0, 0);
    Jog(0, -3000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 300);
    while (ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
}
