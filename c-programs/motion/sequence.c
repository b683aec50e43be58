// cc67: run
//
// sequence.c - a list of positions with a pause at each of them.
//
//   cc67 run c-programs/motion/sequence.c
//
// Expect five stations and the way back, twice.

#include "KMotionDef.h"
#include "step_axis.c"

#define AXIS     4
#define CYCLES   2
#define STATIONS 6

typedef struct
{
    double Position;        // steps
    double Pause;           // seconds at this station
    char *Name;
} STATION;

STATION Station[STATIONS] =
{
    {  2000.0, 0.2, "load" },
    {  4000.0, 0.2, "drill" },
    {  6000.0, 0.1, "blow off" },
    {  8000.0, 0.2, "test" },
    { 10000.0, 0.2, "unload" },
    {     0.0, 0.0, "home" }
};

void Go(STATION *To)
{
    Move(AXIS, To->Position);
    while (!CheckDone(AXIS)) ;          // meanwhile other threads run
    printf("%-8s at %5.0f\n", To->Name, chan[AXIS].Dest);
    Delay_sec(To->Pause);
}

main()
{
    int Cycle, i;

    SetupStepAxis(AXIS, 40000.0f, 400000.0f, 4e6f);

    for (Cycle = 1; Cycle <= CYCLES; Cycle++)
    {
        printf("cycle %d\n", Cycle);
        for (i = 0; i < STATIONS; i++) Go(&Station[i]);
    }
}
