// cc67: part of mutex.c
//
// mutex_adder.c - the second thread of mutex.c: adds in every round that mutex.c starts.

#include "KMotionDef.h"
#include "mutex_adder.h"

main()
{
    int Kind;

    while ((Kind = persist.UserData[ROUND]) != FINISHED)
    {
        if (Kind == IDLE)
        {
            WaitNextTimeSlice();
        }
        else
        {
            Add(Kind);
            persist.UserData[ROUND] = IDLE;
        }
    }
}
