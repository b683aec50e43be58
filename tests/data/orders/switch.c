// cc67: run --for 5 also 2:switch_2.c
#include "KMotionDef.h"

main()
{
    int edges = 0, last = 0, now, i;

    persist.UserData[130] = 1;
    for (i = 0; i < 40; i++)
    {
        WaitNextTimeSlice();
        now = persist.UserData[131];
        edges += now && !last;
        last = now;
    }
    printf("%s\n", edges == 1 ? "one edge" : "missed");
    persist.UserData[130] = 0;
}
