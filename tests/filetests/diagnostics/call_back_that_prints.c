//@ args: check
//@ snapshot
#include "KMotionDef.h"

void Report(void)
{
    printf("limit\n");
}

void Watch(void)
{
    if (ReadBit(136)) Report();
}

main()
{
    UserCallBack = Watch;
}
