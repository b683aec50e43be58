// read-early: persist.UserData[35]
#include "KMotionDef.h"

main()
{
    int start = TIMER0;

    while (TIMER0 - start < 100000)
        ;
    persist.UserData[35] = 2540;  // <-
    persist.UserData[36] = 1;
}
