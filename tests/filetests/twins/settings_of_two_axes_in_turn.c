//@ prints: 200000
#include "KMotionDef.h"

main()
{
    ch0->Vel = 10000;
    ch1->Vel = 20000;
    ch0->Accel = 100000;
    ch1->Accel = 200000;

    ch1->P = 2;
    ch1->I = 0.1;
    ch0->I = 0.2;
    ch1->D = 3;
    ch1->MaxErr = 100;
    printf("%g\n", ch1->Accel);
}
