//@ args: --for 0.1
//@ exit: 3
//@ says: warning[call-back-wait]: `Delay_sec` in the call-back may wait
//@ says:    ┌─ call_back_that_waits.c:18:5
//@ says:    │
//@ says: 16 │ void Tick(void)
//@ says:    │      ---- runs in every servo interrupt
//@ says: 17 │ {
//@ says: 18 │     Delay_sec(1);
//@ says:    │     ^^^^^^^^^^^^ the board hangs if it does
//@ says:    │
//@ says:    = help: set a variable here, and call the function in a thread that checks the variable
//@ says: call-back stopped at call_back_that_waits.c:18:5 in `Tick`: the call-back called a function that waits
#include "KMotionDef.h"

void Tick(void)
{
    Delay_sec(1);
}

main()
{
    UserCallBack = Tick;
    Delay_sec(0.05);
    UserCallBack = 0;
}
