//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define COUNT 5

main()
{
    COUNT = COUNT + 1;
    COUNT++;
}
