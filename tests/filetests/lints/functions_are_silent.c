//@ args: check
// How functions are written: without types, without prototypes, without a value at the end.
#include "KMotionDef.h"

typedef void ACTION(void);

int Ready();
int Helper(int axis);

enum { FIRST = 1, SECOND };
enum { FIRST = 1 };

void Nothing()
{
    return;
}

int NobodyAsks(int axis)
{
    if (axis > 3) return 1;
    EnableAxis(axis);
}

Toggle(int n)
{
    SetStateBit(n, !ReadBit(n));
}

struct Step { int bit; ACTION *action; } steps[2] = { { 46, Nothing }, { 47, &Nothing } };

void main(void)
{
    int i;
    NobodyAsks(2);
    (void)NobodyAsks(1);
    Later(46, &i);
    for (i = 0; i < 2; i++, NobodyAsks(i)) steps[i].action();
    if (Ready() && Helper(1)) (*steps[0].action)();
    int axis = Ready() ? 1 : 2;
    DisableAxis(axis);
    (void)ReadBit(3);
    Nothing();
}

int Later(int bit, int *state)
{
    *state = ReadBit(bit);
}

int Ready()
{
    while (1)
    {
        if (ReadBit(136)) return 1;
        WaitNextTimeSlice();
    }
}

int Helper(int axis)
{
    switch (axis)
    {
    case 0: return 5;
    default: return 6;
    }
}
