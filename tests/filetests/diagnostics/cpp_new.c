//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double *samples = new double[100];

    samples[0] = ch0->Position;
    delete samples;
}
