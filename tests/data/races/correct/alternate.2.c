#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 200; i++)
    {
        while (persist.UserData[20] != 1)
            ;
        persist.UserData[21]--;
        persist.UserData[20] = 0;
    }
}
