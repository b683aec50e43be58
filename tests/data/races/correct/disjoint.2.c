#include "KMotionDef.h"

main()
{
    int i, k;

    for (k = 0; k < 100; k++)
        for (i = 10; i < 20; i++)
            persist.UserData[130 + i] += k;
}
