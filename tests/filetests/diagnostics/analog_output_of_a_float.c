//@ exit: 1
//@ snapshot
//
// The macro DAC combines its value with a mask, which a float has not.

#include "KMotionDef.h"

float Speed = 12000;

main()
{
    DAC(0, Speed / 24000 * 2047);
    DAC(0, (int)(Speed / 24000 * 2047));
}
