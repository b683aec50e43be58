#include "KMotionDef.h"

main()
{
    int i;

    while (!persist.UserData[30])
        for (i = 0; i < 8; i++)
            SetStateBit(1040 + i, persist.UserData[20 + i]);
}
