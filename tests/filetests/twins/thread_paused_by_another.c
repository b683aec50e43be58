//@ args: 2:parts/pauses.c
//@ prints: resumed
#include "KMotionDef.h"

main()
{
    Delay_sec(0.5);
    printf("resumed\n");
}
