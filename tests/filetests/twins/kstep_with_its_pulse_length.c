#include "KMotionDef.h"

main()
{
    KStepPresent = TRUE;
    FPGA(KAN_TRIG_REG) = 4;
    FPGA(STEP_PULSE_LENGTH_ADD) = 63 + 0x80;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->OutputChan0 = 8;
    SetBitDirection(45, 1);
    SetBit(45);
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
