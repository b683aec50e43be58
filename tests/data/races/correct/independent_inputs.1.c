#include "KMotionDef.h"

main()
{
    int i, k;

    for (k = 0; k < 500; k++)
        for (i = 0; i < 8; i++)
            persist.UserData[20 + i] = (k >> i) & 1;
    persist.UserData[30] = 1;
}
