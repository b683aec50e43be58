#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 400; i++)
        SetStateBit(1027, i & 1);
}
