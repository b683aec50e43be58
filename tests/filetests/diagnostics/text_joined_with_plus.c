//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    printf("position " + ch0->Position + "\n");
}
