//@ args: --stim parts/becomes.stim
//@ prints: 1, Dest between 590 and 620: 1
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    EnableAxisDest(0, 0);
    MoveAtVel(0, 1000, 1000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    printf("%d, Dest between 590 and 620: %d\n", persist.UserData[20], ch0->Dest > 590 && ch0->Dest < 620);
}
