//@ exit: 1
#include "KMotionDef.h"

main()
{
    int *p;
    p = 1.5f; //~ error: cannot convert
}
