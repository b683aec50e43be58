// cc67: run
//
// virtual_bits.c - bits without pins, as flags between programs and the PC.
//
//   cc67 run c-programs/io/virtual_bits.c
//
// Bits 48 to 63 are the low 16 bits of VirtualBits; 1024 to 2047 are the 32 words
// of VirtualBitsEx. Bit functions and plain assignments do the same.
//
// Expect 0009 in the first word, bit 52 set by an assignment, and bit 1060 as
// bit 4 of word 1.

#include "KMotionDef.h"

#define FIRST_VIRTUAL 48

main()
{
    VirtualBits = 0;
    SetBit(FIRST_VIRTUAL);
    SetBit(FIRST_VIRTUAL + 3);
    printf("VirtualBits = %04X\n", VirtualBits);

    VirtualBits |= 1 << 4;
    printf("bit 52 = %d, bit 53 = %d\n", ReadBit(52), ReadBit(53));

    VirtualBitsEx[1] = 0;
    SetBit(VIRTUAL_BITS_EX + 32 + 4);
    printf("VirtualBitsEx[1] = %08X\n", VirtualBitsEx[1]);

    VirtualBitsEx[1] = 0;
    VirtualBits = 0;
    printf("bit 52 = %d, bit 1060 = %d\n", ReadBit(52), ReadBit(1060));
}
