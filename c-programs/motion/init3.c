// cc67: run
//
// init3.c - the start-up program of a three-axis router with a KStep amplifier.
//
//   cc67 run c-programs/motion/init3.c
//
// The four duties of such a program: tell the board what is connected, set up and
// enable each axis, switch the amplifiers on, and say which axes form the
// coordinate system for G code. The differences between the axes are in a table.
//
// Expect one line for each axis and one for the whole.

#include "KMotionDef.h"

#define AXES          3
#define AMPLIFIER_BIT 45        // high: the KStep drives its motors

typedef struct
{
    char Letter;
    int Axis;
    float Vel, Accel, Jerk;     // steps/s, steps/s^2, steps/s^3
    float OutputGain;           // -1 reverses the motor
    int LimitBit;               // both limit switches in series, open when hit
} AXIS_SETUP;

AXIS_SETUP Setup[AXES] =
{
    { 'X', 0, 40000.0f, 400000.0f, 4e6f,  1.0f, 168 },
    { 'Y', 1, 40000.0f, 400000.0f, 4e6f, -1.0f, 169 },
    { 'Z', 2, 20000.0f, 200000.0f, 2e6f,  1.0f, 170 }
};

void NoFilter(IIR *Filter)
{
    Filter->B0 = 1.0f;
    Filter->B1 = Filter->B2 = 0.0f;
    Filter->A1 = Filter->A2 = 0.0f;
}

void SetupAxis(AXIS_SETUP *s)
{
    int i;
    CHAN *ch = &chan[s->Axis];

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = STEP_DIR_MODE;
    ch->OutputChan0 = 8 + s->Axis;
    ch->OutputGain = s->OutputGain;
    ch->Vel = s->Vel;
    ch->Accel = s->Accel;
    ch->Jerk = s->Jerk;
    ch->MasterAxis = -1;
    ch->BacklashMode = BACKLASH_OFF;
    ch->MaxFollowingError = 1e9;
    ch->LimitSwitchOptions = 0x100;         // bit numbers below; nothing watched yet
    ch->LimitSwitchNegBit = s->LimitBit;
    ch->LimitSwitchPosBit = s->LimitBit;
    ch->SoftLimitPos = 1e30f;
    ch->SoftLimitNeg = -1e30f;
    for (i = 0; i < N_IIR_FILTERS; i++) NoFilter(&ch->iir[i]);

    EnableAxisDest(s->Axis, 0.0);
    printf("%c: axis %d, %.0f steps/s, %s\n", s->Letter, s->Axis, ch->Vel,
           ch->Enable ? "enabled" : "not enabled");
}

main()
{
    int i;

    KStepPresent = TRUE;
    FPGA(KAN_TRIG_REG) = 4;                         // PWM 0 as the KStep's analog output
    FPGA(STEP_PULSE_LENGTH_ADD) = 63 + 0x80;        // pulses of about 4 us, active high

    for (i = 0; i < AXES; i++) SetupAxis(&Setup[i]);

    SetBitDirection(AMPLIFIER_BIT, 1);
    SetBit(AMPLIFIER_BIT);

    DefineCoordSystem(Setup[0].Axis, Setup[1].Axis, Setup[2].Axis, -1);
    printf("coordinate system: X %d Y %d Z %d A %d, amplifiers %s\n",
           CS0_axis_x, CS0_axis_y, CS0_axis_z, CS0_axis_a,
           ReadBit(AMPLIFIER_BIT) ? "on" : "off");
}
