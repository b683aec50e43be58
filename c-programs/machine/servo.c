// cc67: run
//
// servo.c - tuning a servo: a step, with three sets of gains.
//
//   cc67 run --machine c-programs/machine/servo.toml c-programs/machine/servo.c
//
// Without a machine file a servo axis follows its command whatever its gains are.
// The file beside this program connects a motor to axis 0 that is driven by what the
// board really puts out. So gains matter: little damping overshoots, a hundred times
// the gain swings from one end of the amplifier to the other.
//
// Expect an overshoot of about 16 %, then 9 %, then a motor that never rests.

#include "KMotionDef.h"

#define AXIS 0
#define STEP 400.0

void SetupServoAxis(float P, float D)
{
    CHAN *ch = &chan[AXIS];

    DisableAxis(AXIS);
    ch->InputMode = ENCODER_MODE;
    ch->OutputMode = DC_SERVO_MODE;
    ch->OutputChan0 = 0;
    ch->P = P;
    ch->I = 0.0f;
    ch->D = D;
    ch->MaxOutput = 230.0f;
    ch->MaxFollowingError = 1e6;
    Delay_sec(0.5);                 // the motor runs down
    Zero(AXIS);
    EnableAxisDest(AXIS, 0.0);
}

// The largest output, from one end to the other, in a tenth of a second.
double Swing(void)
{
    double Low = 1e6, High = -1e6, End = Time_sec() + 0.1;

    while (WaitNextTimeSlice() < End)
    {
        if (chan[AXIS].Output < Low) Low = chan[AXIS].Output;
        if (chan[AXIS].Output > High) High = chan[AXIS].Output;
    }
    return High - Low;
}

void Try(float P, float D)
{
    double Peak = 0.0, End;

    SetupServoAxis(P, D);
    chan[AXIS].Dest = STEP;
    End = Time_sec() + 0.5;
    while (WaitNextTimeSlice() < End)
    {
        if (chan[AXIS].Position > Peak) Peak = chan[AXIS].Position;
    }
    printf("P %5.1f D %6.1f: overshoot %2.0f %%, %s\n", P, D, 100.0 * (Peak - STEP) / STEP,
           Swing() < 100.0 ? "at rest" : "swings for ever");
}

main()
{
    Try(1.0f, 50.0f);
    Try(2.0f, 100.0f);
    Try(100.0f, 5000.0f);
    DisableAxis(AXIS);
}
