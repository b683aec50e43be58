// cc67: run also 2:slices_companion.c also 3:slices_companion.c
//
// slices.c - how often a thread gets its turn.
//
//   cc67 run 1:c-programs/threads/slices.c 2:c-programs/threads/slices_companion.c
//            3:c-programs/threads/slices_companion.c
//
// Every servo tick of 90 us another thread gets the processor, the system's own
// thread among them: the period is (active user threads + 1) * 90 us.
//
// Expect 180, 270, 360 and again 270 us, and an end by itself: threads that are
// paused do not keep a run alive.

#include "KMotionDef.h"

#define SLICES 1000

void ShowPeriod(char *Who)
{
    int i;
    double T0, T1;

    T0 = WaitNextTimeSlice();
    for (i = 0; i < SLICES; i++) T1 = WaitNextTimeSlice();

    printf("%-22s %.0f us\n", Who, (T1 - T0) / SLICES * 1e6);
}

main()
{
    PauseThread(2);         // whatever was running there before
    PauseThread(3);
    ShowPeriod("alone:");

    StartThread(2);
    ShowPeriod("with thread 2:");

    StartThread(3);
    ShowPeriod("with threads 2 and 3:");

    PauseThread(2);
    ShowPeriod("with thread 3:");

    PauseThread(3);
}
