#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 3000; i++)
        if (i % 7)
            persist.UserData[10]++;
        else
            persist.UserData[11]++;
    persist.UserData[12] = 1;
}
