// Directions, latches, read-back, LEDs, virtual bits as words of memory.
//@ says: bit 128
//@ says: ReadBit(5000)
//@ prints: 1 1 0
//@ prints: 0 1 1
//@ prints: 1 1 5
//@ prints: 0 0 0
#include "KMotionDef.h"

main()
{
    printf("%d %d %d\n", ReadBit(46), GetBitDirection(46), GetBitDirection(0));
    ClearBit(46);
    SetBitDirection(8, 1);
    SetBit(8);
    printf("%d %d %d\n", ReadBit(46), ReadBit(8), GetBitDirection(8));
    SetBit(48);
    SetStateBit(50, 5);
    VirtualBitsEx[1] = 1;
    printf("%d %d %d\n", ReadBit(48), ReadBit(1056), VirtualBits);
    SetBit(128);
    printf("%d %d %d\n", ReadBit(128), ReadBit(5000), ReadBit(200));
}
//@ cycles: 27917
