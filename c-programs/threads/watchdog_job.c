// cc67: part of watchdog.c
//
// watchdog_job.c - a job that waits for something that never comes.

#include "KMotionDef.h"
#include "watchdog.h"

#define NEVER 1042                  // virtual bit that nobody sets

main()
{
    for (;;)
    {
        persist.UserData[ROUNDS]++;
        Delay_sec(0.01);
        if (persist.UserData[ROUNDS] == 25)
        {
            while (!ReadBit(NEVER)) ;           // the mistake
        }
    }
}
