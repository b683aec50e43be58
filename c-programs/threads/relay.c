// cc67: run also 2:relay.c
//
// relay.c - two threads that start each other.
//
//   cc67 run 1:c-programs/threads/relay.c 2:c-programs/threads/relay.c
//
// The same program is loaded in thread 1 and in thread 2. One runs a lap, hands
// over to the other and ends; a thread is started again from its beginning.
// Globals could not carry the state from one to the other, persist can.
//
// Expect six laps, the threads alternating.

#include "KMotionDef.h"

#define TURN 20             // persist: the thread whose turn it is, 0 = nobody yet
#define LAP  21             // persist: laps run
#define LAPS 6

main()
{
    int Me = CurrentThread;
    int Other = 3 - Me;

    if (persist.UserData[TURN] == 0) persist.UserData[TURN] = 1;
    if (persist.UserData[TURN] != Me) ThreadDone();     // started out of turn: go home

    persist.UserData[LAP]++;
    printf("lap %d: thread %d\n", persist.UserData[LAP], Me);

    if (persist.UserData[LAP] < LAPS)
    {
        WaitNextTimeSlice();                // a whole slice for the hand-over
        persist.UserData[TURN] = Other;
        StartThread(Other);
    }
    else
    {
        persist.UserData[TURN] = -1;        // nobody's turn: finished
    }
}
