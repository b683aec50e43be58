//@ prints: on
#include "KMotionDef.h"

#define ON(bit) SetBitDirection(bit, 1); SetBit(bit)
#define OFF(bit) do { SetBitDirection(bit, 1); ClearBit(bit); } while (0)

main()
{
    ON(40);
    if (!ReadBit(40)) { ON(40); }
    if (!ReadBit(40)) OFF(40);
    printf(ReadBit(40) ? "on\n" : "off\n");
}
