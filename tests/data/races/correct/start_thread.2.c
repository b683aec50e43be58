#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 10; i++)
        persist.UserData[40 + i] *= 2;
    persist.UserData[50] = 1;
}
