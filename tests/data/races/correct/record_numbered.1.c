#include "KMotionDef.h"

#define NUMBER persist.UserData[150]
#define FIELD(i) persist.UserData[151 + (i)]

main()
{
    int i, k;

    for (k = 0; k < 500; k++)
    {
        NUMBER = 2 * k + 1;
        for (i = 0; i < 4; i++)
            FIELD(i) = k * (i + 1);
        NUMBER = 2 * k + 2;
        WaitNextTimeSlice();
    }
    NUMBER = -2;
}
