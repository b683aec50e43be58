//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

const int SAMPLES = 100;
double buffer[SAMPLES];

main()
{
    buffer[0] = ch0->Position;
}
