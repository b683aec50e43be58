// A service loop around a switch, with its state in a global that others may read.
//@ prints: idle
//@ prints: clamp open
//@ prints: turning 0
//@ prints: turning 1
//@ prints: turning 2
//@ prints: clamp closed
//@ prints: done after 6 passes
#include "KMotionDef.h"

#define T_IDLE 0
#define T_OPEN 1
#define T_TURN 2
#define T_CLOSE 3
#define T_DONE 4

int State = T_IDLE, Passes = 0, Turned;

Service()
{
    switch (State)
    {
    case T_IDLE: printf("idle\n"); State = T_OPEN; break;
    case T_OPEN: printf("clamp open\n"); Turned = 0; State = T_TURN; break;
    case T_TURN:
        printf("turning %d\n", Turned++);
        if (Turned == 3) State = T_CLOSE;
        break;
    case T_CLOSE: printf("clamp closed\n"); State = T_DONE; break;
    default: break;
    }
}

main()
{
    for (;;)
    {
        WaitNextTimeSlice();
        Service();
        Passes++;
        if (State == T_DONE) break;
    }
    printf("done after %d passes\n", Passes);
}
//@ cycles: 25244
