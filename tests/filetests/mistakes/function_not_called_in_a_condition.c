//@ args: check
//@ says: warning[missing-call]: `CheckDone` is not called here
//@ says: function_not_called_in_a_condition.c:8:13
#include "KMotionDef.h"

main()
{
    while (!CheckDone)
        ;
}
