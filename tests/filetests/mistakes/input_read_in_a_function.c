//@ says: thread 1 at input_read_in_a_function.c:6:12 in `Pressed` reads bit 138, an input that nothing drives; it stays 0
#include "KMotionDef.h"

int Pressed(int bit)
{
    return ReadBit(bit);
}

main()
{
    if (Pressed(138)) printf("pressed\n");
}
