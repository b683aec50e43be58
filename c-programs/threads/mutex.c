// cc67: run -R no-race-update also 2:mutex_adder.c
//
// mutex.c - why two threads that change the same value need a lock.
//
//   cc67 run 1:c-programs/threads/mutex.c 2:c-programs/threads/mutex_adder.c
//
// Both threads add to one counter: they read it, need some time, and write it
// back. Without the lock each overwrites what the other added meanwhile. With the
// lock the other waits.
//
// Expect lost counts in the first round and none in the second.

#include "KMotionDef.h"
#include "mutex_adder.h"

int Round(int Kind)
{
    persist.UserData[COUNTER] = 0;
    persist.UserData[ROUND] = Kind;         // the other thread waits for this

    Add(Kind);
    while (persist.UserData[ROUND] != IDLE) WaitNextTimeSlice();

    return persist.UserData[COUNTER];
}

main()
{
    int Count;

    persist.UserData[LOCK] = 0;
    persist.UserData[ROUND] = IDLE;
    StartThread(2);

    Count = Round(UNLOCKED);
    if (Count < 2 * ADDITIONS) printf("without a lock: counts were lost\n");
    else printf("without a lock: %d, lucky\n", Count);

    Count = Round(LOCKED);
    printf("with the lock:  %d of %d\n", Count, 2 * ADDITIONS);

    persist.UserData[ROUND] = FINISHED;
}
