//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

double positions[100000];
double velocities[20000];

main()
{
    positions[0] = velocities[0] = 1;
}
