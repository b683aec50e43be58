//@ args: --machine ../mistakes/parts/millimetres.toml
//@ prints: 250.0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputGain = 400;          // steps in a millimetre
    ch0->Vel = 400;
    ch0->Accel = 2000;
    ch0->Jerk = 20000;
    EnableAxisDest(0, 20);
    Jog(0, -10);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
    Move(0, 250);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("%.1f\n", ch0->Dest);
}
