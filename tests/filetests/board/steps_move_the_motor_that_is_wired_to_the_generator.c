//@ args: --machine parts/crossed.toml
//@ prints: 0 has moved: 0, 1 has moved: 1
//@ says: EnableAxisDest: axis 0 drives step generator 0 (OutputMode, OutputChan0), but its motor is connected to step generator 1
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    EnableAxisDest(0, 0);
    Move(0, 100);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(0.01);
    printf("0 has moved: %d, 1 has moved: %d\n", ReadBit(136), ReadBit(137));
}
