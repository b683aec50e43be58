//@ args: --for 0.5
//@ says: warning[endless-wait]: this loop waits for `ready`, which nothing in the program changes
//@ says:    ┌─ wait_for_a_flag_nobody_sets.c:17:12
//@ says:    │
//@ says: 17 │     while (!ready)
//@ says:    │            ^^^^^^ the same in every iteration
//@ says:    │
//@ says:    = help: no other thread can change it: use `persist.UserData` or a virtual bit, which threads share
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_a_flag_nobody_sets.c:18:9 in `main` has waited since 0.000 s for `ready` (now 0), which nothing writes, in `!ready`
#include "KMotionDef.h"

int ready;

main()
{
    while (!ready)
        WaitNextTimeSlice();
}
