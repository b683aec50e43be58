//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    printf('hello\n');
}
