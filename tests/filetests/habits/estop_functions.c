// A helper that only makes sense as part of a program.
//@ args: check
//@ exit: 1
//@ says: no `main`
//@ says: this file is included by estop.c
#include "KMotionDef.h"

#define ESTOP_BIT 1030

int EStopPressed()
{
    return ReadBit(ESTOP_BIT);
}

void AllOff()
{
    int i;
    for (i = 0; i < 8; i++) DisableAxis(i);
    printf("all off\n");
}
