// cc67: run --for 5 also 2:request_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 1; i <= 10; i++)
    {
        Delay_sec(0.001);
        persist.UserData[71] = i;
        persist.UserData[70] = 1;
    }
    Delay_sec(0.002);
    printf("%d served\n", persist.UserData[72]);
    persist.UserData[70] = -1;
}
