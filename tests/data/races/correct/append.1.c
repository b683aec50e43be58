#include "KMotionDef.h"

#define COUNT persist.UserData[10]
#define ITEM(i) persist.UserData[11 + (i)]

main()
{
    int i;

    for (i = 0; i < 80; i++)
    {
        ITEM(i) = i * i;
        COUNT = i + 1;
        WaitNextTimeSlice();
    }
}
