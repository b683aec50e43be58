#include "KMotionDef.h"

main()
{
    int n, i, sum;

    do
    {
        n = persist.UserData[10];
        sum = 0;
        for (i = 0; i < n; i++)
            sum += persist.UserData[11 + i];
        persist.UserData[95] = sum;
    } while (n < 80);
}
