#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 5000; i++)
        persist.UserData[5]++;
    persist.UserData[6] = 1;
}
