//@ args: --set persist.99=f:1500 --set persist.98=3
#include "KMotionDef.h"

main()
{
    float rpm = *(float *)&persist.UserData[99];
    int tool = persist.UserData[98];
    // A copy of the bits.
    persist.UserData[20] = persist.UserData[99];
    if (rpm > 24000) rpm = 24000;
    DAC(0, (int)(rpm * 2047 / 24000) + tool);
}
