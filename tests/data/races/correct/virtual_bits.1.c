#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 400; i++)
    {
        SetBit(1024);
        ClearBit(1024);
    }
}
