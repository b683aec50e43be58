//@ prints: 1000 0
#include "KMotionDef.h"

main()
{
    int place;
    short counts;
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 1;
    EnableAxis(0);
    Move(0, 1000);
    while (fast_fabs(ch0->Position - 1000) > 0.5) ;
    place = ch0->Position + 0.5;
    counts = 0;
    printf("%d %d\n", place, counts);
}
