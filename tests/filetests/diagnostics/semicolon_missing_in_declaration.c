//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

int count
double position = 0

main()
{
    count = 5;
    position = count;
}
