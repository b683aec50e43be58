//@ prints: 10
#include "KMotionDef.h"

main()
{
    ch0->InputMode = USER_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    EnableAxisDest(0, 0);
    Move(0, 10);
    while (!CheckDone(0)) ch0->Position = ch0->Dest;
    printf("%.0f\n", ch0->Dest);
}
