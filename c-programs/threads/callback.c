// cc67: run
//
// callback.c - a function that the board calls in every servo tick.
//
//   cc67 run c-programs/threads/callback.c
//
// The call-back runs in interrupt time: it must be short, and it must never wait
// or print. It stays installed when the program ends, so this one removes it.
//
// Expect as many calls as ticks, then none any more.

#include "KMotionDef.h"

volatile int Calls = 0;

void EveryTick(void)
{
    Calls++;
}

main()
{
    double First;
    int Ticks, Difference, After;

    UserCallBack = EveryTick;
    WaitNextTimeSlice();
    Calls = 0;
    First = ServoTick;
    Delay_sec(0.045);
    Ticks = (int)(ServoTick - First);
    Difference = Ticks - Calls;
    if (Difference >= -1 && Difference <= 1) printf("one call in each tick\n");
    else printf("%d calls in %d ticks\n", Calls, Ticks);

    UserCallBack = NULL;
    WaitNextTimeSlice();
    After = Calls;
    Delay_sec(0.045);
    printf("%d calls after it was removed\n", Calls - After);
}
