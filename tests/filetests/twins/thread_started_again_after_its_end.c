//@ args: 2:../mistakes/parts/takes_a_second.c
//@ prints: twice
#include "KMotionDef.h"

main()
{
    StartThread(2);
    Delay_sec(1.5);
    StartThread(2);
    printf("twice\n");
}
