//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    Move(0 1000);
    printf("%d\n" 5);
}
