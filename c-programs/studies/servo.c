// cc67: run
//
// servo.c - a servo axis whose gains are set from outside, for the studies beside it.
//
// persist.UserData 10, 11 and 12 hold P, I and D as floats, 13 the largest output in counts. A study sets
// them before the program starts; where nothing is set the axis has P = 1 and nothing else.
//
// Expect the axis to be enabled, at rest at 0.

#include "KMotionDef.h"

#define AXIS 0

float Setting(int Index, float Usual)
{
    float Value = *(float *)&persist.UserData[Index];

    return Value != 0.0f ? Value : Usual;
}

main()
{
    CHAN *ch = &chan[AXIS];

    ch->InputMode = ENCODER_MODE;
    ch->InputGain0 = 0.05;                  // 20 counts of the encoder to a unit
    ch->OutputMode = DAC_SERVO_MODE;
    ch->OutputChan0 = 0;
    ch->P = Setting(10, 1.0f);
    ch->I = Setting(11, 0.0f);
    ch->D = Setting(12, 0.0f);
    ch->MaxOutput = Setting(13, 2000.0f);
    ch->MaxErr = 1e6;
    ch->MaxI = 200.0f;
    ch->MaxFollowingError = 1e6;
    ch->Vel = 20000.0;
    ch->Accel = 400000.0;
    ch->Jerk = 2e7;
    EnableAxisDest(AXIS, 0.0);
    printf("P %.3f I %.5f D %.2f\n", ch->P, ch->I, ch->D);
}
