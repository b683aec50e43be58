// mutex_adder.h - what both threads of mutex.c share.
//
// Everything shared lies in persist: each program is linked for itself, so a
// global of one is not the global of the other.

#define LOCK    30          // persist: the mutex, 0 = free
#define COUNTER 31          // persist: the value both threads add to
#define ROUND   32          // persist: what to do now, one of the following

#define IDLE     0
#define UNLOCKED 1
#define LOCKED   2
#define FINISHED 3

#define ADDITIONS 50

void Add(int Kind)
{
    int i, Value;

    for (i = 0; i < ADDITIONS; i++)
    {
        if (Kind == LOCKED) MutexLock(&persist.UserData[LOCK]);

        Value = persist.UserData[COUNTER];
        WaitNextTimeSlice();                // the other thread comes in between
        persist.UserData[COUNTER] = Value + 1;

        if (Kind == LOCKED) MutexUnlock(&persist.UserData[LOCK]);
    }
}
