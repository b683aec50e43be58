//@ args: check
//@ says: warning[multistatement-macro]: only the first statement of the macro `HALT` depends on the condition
//@ says: macro_of_two_statements_after_if.c:10:22
#include "KMotionDef.h"

#define HALT(axis) Jog(axis, 0); DisableAxis(axis)

main()
{
    if (ReadBit(46)) HALT(0);
}
