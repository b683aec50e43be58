//@ args: check
//@ says: warning[unreachable-code]: this statement is never executed
//@ says: statements_after_return.c:12:5
#include "KMotionDef.h"

main()
{
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) ;
    return 0;
    DisableAxis(0);
}
