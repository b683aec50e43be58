// cc67: part of debounce.c
//
// debounce_switch.c - plays contacts that bounce when they close and open.

#include "KMotionDef.h"

#define BUTTON  1024
#define LIMIT   1025
#define END_BIT 1031

// The contact changes to its new level, but not at once: it jumps back and forth
// a few times, half a millisecond each.
void Contact(int Bit, int Level)
{
    int i;

    for (i = 0; i < 4; i++)
    {
        SetStateBit(Bit, Level);
        Delay_sec(0.0005);
        SetStateBit(Bit, !Level);
        Delay_sec(0.0005);
    }
    SetStateBit(Bit, Level);
    Delay_sec(0.03);
}

main()
{
    Contact(BUTTON, 1);
    Contact(LIMIT, 1);
    Contact(BUTTON, 0);
    Contact(LIMIT, 0);
    SetBit(END_BIT);
}
