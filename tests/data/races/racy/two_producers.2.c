#include "KMotionDef.h"

#define IN persist.UserData[110]
#define RING(i) persist.UserData[120 + ((i) & 15)]

main()
{
    int i;

    for (i = 0; i < 1500; i++)
    {
        RING(IN) = -i;
        IN++;  // <-
    }
}
