#include "KMotionDef.h"

main()
{
    int start = persist.UserData[5], n;

    do
    {
        n = persist.UserData[5] - start;
        persist.UserData[7] = n;
    } while (!persist.UserData[6]);
}
