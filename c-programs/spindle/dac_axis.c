// cc67: run
//
// dac_axis.c - a spindle with an analog speed input, run as an axis.
//
//   cc67 run c-programs/spindle/dac_axis.c
//
// No feedback and no gains: the output is the commanded speed times FFVel. One unit
// of the axis per second means full speed, so a jog of 0.5 is half speed. The axis
// brings soft ramps along. Kanalog outputs are inverted, hence the gain of -1.
//
// Expect half and full speed as 5 and 10 V, and 0 V after the ramp down.

#include "KMotionDef.h"

#define AXIS    7
#define CHANNEL 7               // analog output

void SetupSpindle(void)
{
    int i;
    CHAN *ch = &chan[AXIS];

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = DAC_SERVO_MODE;
    ch->OutputChan0 = CHANNEL;
    ch->OutputGain = -1.0f;
    ch->OutputOffset = 0.0f;
    ch->P = ch->I = ch->D = 0.0f;
    ch->FFAccel = 0.0f;
    ch->FFVel = 2047.0f;            // counts at full speed
    ch->MaxOutput = 2047.0f;
    ch->MaxFollowingError = 1e30;   // nothing is measured
    ch->Vel = 1.0f;
    ch->Accel = 4.0f;               // full speed in a quarter of a second
    ch->Jerk = 40.0f;
    for (i = 0; i < N_IIR_FILTERS; i++)
    {
        ch->iir[i].B0 = 1.0f;
        ch->iir[i].B1 = ch->iir[i].B2 = ch->iir[i].A1 = ch->iir[i].A2 = 0.0f;
    }
    EnableAxisDest(AXIS, 0.0);
}

float OutputVolts(void)
{
    int Counts = (DAC_Buffer[CHANNEL] & 0xfff) - 2048;

    return KANALOG_CONVERT_DAC_TO_VOLTS(Counts);
}

void Run(double Speed)
{
    Jog(AXIS, Speed);
    Delay_sec(0.6);                 // ramp
    printf("speed %4.2f: %4.1f V\n", Speed, fast_fabsf(OutputVolts()));
}

main()
{
    SetupSpindle();
    Run(0.5);
    Run(1.0);
    Run(0.0);
    printf("CheckDone %d\n", CheckDone(AXIS));
    DisableAxis(AXIS);
}
