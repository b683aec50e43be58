// race-update: persist.UserData[110]
#include "KMotionDef.h"

#define IN persist.UserData[110]
#define RING(i) persist.UserData[120 + ((i) & 15)]

void put(int value)
{
    RING(IN) = value;
    IN = IN + 1;  // <-
}

main()
{
    int i;

    for (i = 0; i < 1500; i++)
        put(i);
}
