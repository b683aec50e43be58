#include "KMotionDef.h"

main()
{
    int i, sum = 0;

    for (i = 0; i < 20; i++)
    {
        Delay_sec(0.001);
        sum += persist.UserData[42];
        persist.UserData[42] = 0;  // <-
    }
    persist.UserData[43] = sum;
}
