#include "KMotionDef.h"

#define IN persist.UserData[110]
#define OUT persist.UserData[111]
#define RING(i) persist.UserData[112 + ((i) & 7)]

main()
{
    int i;

    for (i = 0; i < 2000; i++)
    {
        while (IN - OUT >= 8)
            ;
        RING(IN) = i;
        IN++;
    }
    persist.UserData[121] = 1;
}
