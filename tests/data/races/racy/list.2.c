#include "KMotionDef.h"

main()
{
    int i, sum, n;

    while (!persist.UserData[30])
    {
        sum = 0;
        n = persist.UserData[10];
        for (i = 0; i < n; i++)
            sum += persist.UserData[11 + i];  // <-
        persist.UserData[31] = sum;
    }
}
