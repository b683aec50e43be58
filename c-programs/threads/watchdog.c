// cc67: run also 2:watchdog_job.c
//
// watchdog.c - a thread that watches another one and switches the outputs off when it hangs.
//
//   cc67 run 1:c-programs/threads/watchdog.c 2:c-programs/threads/watchdog_job.c
//
// The job counts in persist after each round. If the count does not change for
// too long, the watchdog stops the thread and brings the machine into its safe state. The
// threads are preempted, so even a job that never yields cannot stop the watchdog.
//
// Expect three good checks; then the job hangs and is stopped.

#include "KMotionDef.h"
#include "watchdog.h"

main()
{
    int Last = 0, Count;

    SetBit(MOTORS_ON);
    persist.UserData[ROUNDS] = 0;
    StartThread(JOB);

    for (;;)
    {
        Delay_sec(0.1);
        Count = persist.UserData[ROUNDS];
        if (Count == Last) break;
        printf("%d rounds\n", Count - Last);
        Last = Count;
    }

    PauseThread(JOB);
    ClearBit(MOTORS_ON);
    printf("the job hangs: thread %d stopped, motors %s\n", JOB, ReadBit(MOTORS_ON) ? "on" : "off");
}
