//@ prints: 8 255 5 0.750000 -1
#include "KMotionDef.h"

_Static_assert(010 == 8 && 0xFf == 255 && 0b101 == 5 && 0B11 == 3, "integers"); //~ octal

main()
{
    printf("%d %d %d %f %d\n", 010, 0xff, 0b101, 0x1.8p-1, 0xffffffff); //~ octal
}
//@ cycles: 13805
