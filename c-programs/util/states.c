// cc67: run
//
// states.c - a tool clamp as a state machine with function pointers.
//
//   cc67 run c-programs/util/states.c
//
// Each state is a function that does one slice of work and returns the next state.
// Nothing ever waits inside, so many such machines can share one service loop. A
// table of structures holds the function and its name.
//
// Expect two changes of the tool, then a third one in which the clamp does not open
// and the machine reports the fault.

#include "KMotionDef.h"

#define OPEN_VALVE   1024       // virtual bits in place of a valve and a sensor
#define OPEN_SENSOR  1025
#define OPENS_IN     0.05       // seconds the clamp needs
#define TIME_OUT     0.2
#define CHANGES      3          // in the last one the clamp is stuck

enum { CLOSED, OPENING, OPEN, CLOSING, FAULT, N_STATES };

typedef struct
{
    char *Name;
    int (*Run)(double Elapsed);     // seconds in this state; returns the next state
} STATE;

int ChangesLeft = CHANGES;

int RunClosed(double Elapsed)
{
    if (ChangesLeft == 0) return FAULT;
    if (Elapsed < 0.01) return CLOSED;
    ChangesLeft--;
    SetBit(OPEN_VALVE);
    return OPENING;
}

int RunOpening(double Elapsed)
{
    if (ReadBit(OPEN_SENSOR)) return OPEN;
    return Elapsed > TIME_OUT ? FAULT : OPENING;
}

int RunOpen(double Elapsed)
{
    if (Elapsed < 0.03) return OPEN;        // the tool is exchanged
    ClearBit(OPEN_VALVE);
    return CLOSING;
}

int RunClosing(double Elapsed)
{
    if (!ReadBit(OPEN_SENSOR)) return CLOSED;
    return Elapsed > TIME_OUT ? FAULT : CLOSING;
}

int RunFault(double Elapsed)
{
    ClearBit(OPEN_VALVE);
    return FAULT;
}

STATE State[N_STATES] =
{
    { "closed",  RunClosed },
    { "opening", RunOpening },
    { "open",    RunOpen },
    { "closing", RunClosing },
    { "fault",   RunFault }
};

// The clamp itself: its sensor follows the valve a little later, unless stuck.
void PlayClamp(double Now)
{
    static double ValveChanged = 0.0;
    static int Valve = 0;
    int Stuck = ChangesLeft == 0;

    if (ReadBit(OPEN_VALVE) != Valve)
    {
        Valve = !Valve;
        ValveChanged = Now;
    }
    if (Now - ValveChanged > OPENS_IN) SetStateBit(OPEN_SENSOR, Valve && !Stuck);
}

main()
{
    int Is = CLOSED, Next;
    double Now, Entered;

    VirtualBitsEx[0] = 0;
    Entered = Time_sec();
    while (Is != FAULT)
    {
        Now = WaitNextTimeSlice();
        PlayClamp(Now);
        Next = State[Is].Run(Now - Entered);
        if (Next != Is)
        {
            printf("%s -> %s\n", State[Is].Name, State[Next].Name);
            Is = Next;
            Entered = Now;
        }
    }
    State[Is].Run(0.0);
}
