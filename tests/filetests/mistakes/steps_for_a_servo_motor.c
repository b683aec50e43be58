//@ args: --machine parts/ends.toml
//@ says: thread 1 at steps_for_a_servo_motor.c:12:5 in `main`: EnableAxisDest: axis 0 drives step generator 0 (OutputMode, OutputChan0), but its motor is connected to a servo amplifier (model = "motor"), which steps do not turn
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
