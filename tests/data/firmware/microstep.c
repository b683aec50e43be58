// microstep.c - the words of a microstepping axis and of a four-phase motor, through a turn.

#include "KMotionDef.h"

main()
{
    int i;
    CHAN *ch = &chan[0];

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = MICROSTEP_MODE;
    ch->OutputChan0 = 0;
    ch->OutputChan1 = 1;
    ch->StepperAmplitude = 230.0f;
    ch->Lead = 0.0f;
    ch->invDistPerCycle = 1.0;
    EnableAxisDest(0, 0.0);
    for (i = -20; i < 300; i++)
    {
        ch->Dest = i * 0.0037;
        WaitNextTimeSlice();
        WaitNextTimeSlice();
        printf("%d: %d %d\n", i, LastPWM[0] - 1280, LastPWM[1] - 1280);
    }
    DisableAxis(0);
    for (i = -20; i < 300; i++)
    {
        Write4PH(ch, 200.0f, i * 0.0037);
        printf("%d: %d %d\n", i, LastPWM[0] - 1280, LastPWM[1] - 1280);
        if (i % 8 == 0) WaitNextTimeSlice();
    }
}
