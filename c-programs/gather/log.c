// cc67: run
//
// log.c - recording what one axis does, and printing every n-th sample.
//
//   cc67 run c-programs/gather/log.c
//
// SetupGatherAllOnAxis records six values a tick: commanded and measured position,
// the output, and three readings of an amplifier that has them. The list can be
// copied into a table calculation and drawn.
//
// Expect a move from 0 to 1000 in about 0.2 s, a line every 45 ms.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define AXIS    0
#define ITEMS   6               // values in a sample
#define SAMPLES 2600
#define EVERY   500

main()
{
    int i;

    SetupStepAxis(AXIS, 40000.0f, 400000.0f, 4e6f);

    SetupGatherAllOnAxis(AXIS, SAMPLES);
    TriggerGather();
    MoveRel(AXIS, 1000.0);
    while (!CheckDoneGather()) ;

    printf("time, dest\n");
    for (i = 0; i < SAMPLES; i += EVERY)
    {
        printf("%.3f, %.0f\n", i * TIMEBASE, gather_buffer[i * ITEMS]);
    }
}
