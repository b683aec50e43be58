//@ args: --machine ../mistakes/parts/plate.toml
//@ prints: 0 1
#include "KMotionDef.h"

main()
{
    int before;
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->Vel = 10000;
    ch2->Accel = 100000;
    ch2->Jerk = 1e6;
    EnableAxisDest(2, 0);
    before = ReadBit(137);
    Move(2, -6000);
    while (!CheckDone(2)) Delay_sec(0.1);
    printf("%d %d\n", before, ReadBit(137));
}
