#include "KMotionDef.h"

#define STATE persist.UserData[10]
#define SPEED persist.UserData[11]
#define TOOL persist.UserData[12]

main()
{
    int i;

    for (i = 0; i < 2000; i++)
    {
        STATE = i % 5;
        SPEED = 1000 + i;
        TOOL = i / 100;
    }
    STATE = -1;
}
