// Floating values are compared with == and switched on by if.
//@ prints: stopped
//@ prints: float 0.1 is not 0.1
//@ prints: half is half
#include "KMotionDef.h"

double Speed = 0;
float Tenth = 0.1, Half = 0.5;

main()
{
    if (Speed == 0.0) printf("stopped\n");
    if (Tenth != 0.1) printf("float 0.1 is not 0.1\n"); //~ float-equality
    if (Half == 0.5) printf("half is half\n");
    if (!Speed && Speed != 0) printf("wrong\n");
}
//@ cycles: 9104
