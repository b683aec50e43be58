// Outputs packed into a number: shifts, masks, exclusive or, complement.
//@ prints: 5 outputs of a5
//@ prints: bits 1 0 1 0 0 1 0 1, inverted 5a
//@ prints: 3 set, 0x3c
#include "KMotionDef.h"

main()
{
    unsigned char pattern = 0xA5;
    int i, n = 0, word = 0;

    printf("%d outputs of %x\n", 5, pattern);
    printf("bits");
    for (i = 7; i >= 0; i--) printf(i ? " %d" : " %d, ", (pattern >> i) & 1);
    printf("inverted %x\n", ~pattern & 0xff);
    for (i = 0; i < 3; i++)
    {
        SetStateBit(48 + i, (pattern >> i) & 1 ^ 1 | 1);
        n += ReadBit(48 + i);
    }
    word |= 0xf << 2;
    printf("%d set, 0x%x\n", n, word);
}
//@ cycles: 39145
