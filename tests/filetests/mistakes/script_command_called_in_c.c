//@ args: check
//@ exit: 1
//@ says: error: undefined function `SetStartupThread`
//@ says: script_command_called_in_c.c:10:5
//@ says: `SetStartupThread` is a script command of the console; in C write `persist.RunOnStartUp |= 1 << thread`
#include "KMotionDef.h"

main()
{
    SetStartupThread(2, 1);
}
