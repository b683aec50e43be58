//@ args: run 2:parts/ends_at_once.c
//@ prints: still called
#include "KMotionDef.h"

main()
{
    int before;
    Delay_sec(0.1);
    before = persist.UserData[7];
    Delay_sec(0.1);
    if (before > 0 && persist.UserData[7] > before) printf("still called\n");
    UserCallBack = 0;
}
