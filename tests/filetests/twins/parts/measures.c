#include "KMotionDef.h"

main()
{
    Delay_sec(0.2);
    persist.UserData[10] = 42;
    persist.UserData[11] = 1;
}
