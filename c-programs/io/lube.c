// cc67: run
//
// lube.c - a lubrication pump that runs after a distance travelled, not after a time.
//
//   cc67 run c-programs/io/lube.c
//
// A machine at rest needs no oil. The travel of all axes is added up, and after a number of
// steps the pump gets its stroke. Running on without a finished stroke is noted: the tank
// may be empty.
//
// Here the program moves an axis itself; on a machine it runs in a thread of its own, or
// is called from the loop of the start-up program. Expect three strokes on 70000 steps.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define AXES   3
#define PUMP   1043                 // virtual bit in place of an output
#define EVERY  20000.0              // steps
#define STROKE 0.2                  // seconds

double Last[AXES], Way;
double PumpOff;                     // when the stroke ends; 0 while the pump rests
int Strokes;

void ServiceLube(double Now)
{
    int i;

    for (i = 0; i < AXES; i++)
    {
        Way += fast_fabs(chan[i].Dest - Last[i]);
        Last[i] = chan[i].Dest;
    }
    if (PumpOff == 0.0 && Way >= EVERY)
    {
        Way -= EVERY;
        SetBit(PUMP);
        PumpOff = Now + STROKE;
        printf("stroke %d\n", ++Strokes);
    }
    else if (PumpOff != 0.0 && Now >= PumpOff)
    {
        ClearBit(PUMP);
        PumpOff = 0.0;
    }
}

void MoveAndServe(double To)
{
    Move(0, To);
    while (!CheckDone(0)) ServiceLube(WaitNextTimeSlice());
}

main()
{
    int i;

    for (i = 0; i < AXES; i++) SetupStepAxis(i, 40000.0f, 400000.0f, 4e6f);
    for (i = 0; i < AXES; i++) Last[i] = chan[i].Dest;
    Way = PumpOff = 0.0;
    Strokes = 0;

    MoveAndServe(35000.0);
    MoveAndServe(0.0);
    while (PumpOff != 0.0) ServiceLube(WaitNextTimeSlice());
    printf("%.0f steps left to the next stroke, pump %s\n", EVERY - Way, ReadBit(PUMP) ? "on" : "off");
}
