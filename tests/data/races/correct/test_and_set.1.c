#include "KMotionDef.h"

int tries;

main()
{
    int i;

    for (i = 0; i < 300; i++)
    {
        while (TestAndSet(&persist.UserData[30], CurrentThread))
            tries++;
        persist.UserData[31]++;
        persist.UserData[30] = 0;
    }
}
