//@ args: run --for 0.1
//@ prints: here
#include "KMotionDef.h"

main()
{
    printf("here\n");
    for (;;) ; //~ idle-loop
}
