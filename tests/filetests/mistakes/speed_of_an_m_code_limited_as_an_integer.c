//@ args: --set persist.99=f:1500
//@ says: warning[user-data-type]: `persist.UserData[99]` is read as an integer
//@ says: speed_of_an_m_code_limited_as_an_integer.c:9:15
//@ says: write `*(float *)&persist.UserData[99]`
#include "KMotionDef.h"

main()
{
    int rpm = persist.UserData[99];
    if (rpm > 24000) rpm = 24000;
    DAC(0, rpm * 2047 / 24000);
}
