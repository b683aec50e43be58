#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 30; i++)
    {
        Delay_sec(0.002);
        persist.UserData[33] = 1;
        ResumeThread(1);  // <-
    }
}
