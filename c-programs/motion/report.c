// cc67: run
//
// report.c - the settings of all axes in a table.
//
//   cc67 run c-programs/motion/report.c
//
// Run it after a start-up program to see the real settings of the board.
//
// Expect, on a board that has just been switched on, eight axes with encoder inputs
// and no outputs, none of them enabled.

#include "KMotionDef.h"

main()
{
    int i;
    CHAN *ch;

    printf("axis  input      output     enabled    vel   accel     jerk\n");
    for (i = 0; i < N_CHANNELS; i++)
    {
        ch = &chan[i];
        printf("%4d  %-9s  %-9s  %-7s %6.0f  %6.0f  %7.0f\n", i,
               TranslateInputMode(ch->InputMode), TranslateOutputMode(ch->OutputMode),
               ch->Enable ? "yes" : "no", ch->Vel, ch->Accel, ch->Jerk);
    }
}
