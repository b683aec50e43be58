//@ args: check
//@ says: warning[empty-body]: `if` with an empty body
//@ says: semicolon_after_if.c:8:21
#include "KMotionDef.h"

main()
{
    if (ReadBit(12));
        SetBit(46);
}
