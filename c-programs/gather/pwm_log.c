// cc67: run
//
// pwm_log.c - recording what a stepper motor gets, and printing every tenth sample.
//
//   cc67 run c-programs/gather/pwm_log.c
//
// The gather facility copies a list of variables into a large buffer, once a servo
// tick. Here it records the two coils of a microstepped motor and the commanded
// position for half a second, beginning a moment before the motor moves.
//
// Expect 556 lines: number of the sample, both coils in PWM counts, position in
// cycles. The coils are the sine and cosine of the position, and the position ends
// at 20.

#include "KMotionDef.h"

#define AXIS  0
#define ITEMS 3                 // values in a sample

void SetupMicrostepAxis(CHAN *ch)
{
    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = MICROSTEP_MODE;
    ch->OutputChan0 = 0;
    ch->OutputChan1 = 1;
    ch->StepperAmplitude = 200.0f;
    ch->Lead = 0.0f;
    ch->invDistPerCycle = 1.0;  // one unit is one cycle
    ch->Vel = 200.0f;
    ch->Accel = 2000.0f;
    ch->Jerk = 100000.0f;
    EnableAxisDest(AXIS, 0.0);
}

main()
{
    int i, Samples = 0.5 / TIMEBASE;

    SetupMicrostepAxis(&chan[AXIS]);

    gather.Inject = FALSE;
    gather.list[0].type = GATHER_LASTPWM_TYPE;
    gather.list[0].addr = &LastPWM[0];
    gather.list[1].type = GATHER_LASTPWM_TYPE;
    gather.list[1].addr = &LastPWM[1];
    gather.list[2].type = GATHER_DOUBLE_TYPE;
    gather.list[2].addr = &chan[AXIS].Dest;
    gather.list[3].type = GATHER_END_TYPE;
    gather.bufptr = (double *)0xfffffffc;       // beyond the end: idle
    gather.endptr = gather_buffer + ITEMS * Samples;

    TriggerGather();
    MoveRel(AXIS, 20.0);
    while (!CheckDoneGather()) ;

    for (i = 0; i < Samples; i += 10)
    {
        printf("%d,%.0f,%.0f,%.4f\n", i, gather_buffer[i * ITEMS],
               gather_buffer[i * ITEMS + 1], gather_buffer[i * ITEMS + 2]);
    }
}
