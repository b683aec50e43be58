#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 500; i++)
    {
        persist.UserData[75] = 1000 + i;
        WaitNextTimeSlice();
    }
}
