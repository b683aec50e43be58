//@ args: --stim parts/stored.stim
#include "KMotionDef.h"

main()
{
    *(float *)&persist.UserData[20] = 2.0;
    persist.UserData[21] = 3;
    *(double *)&persist.UserData[22] = 2.5;
}
