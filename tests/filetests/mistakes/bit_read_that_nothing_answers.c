//@ says: thread 1 at bit_read_that_nothing_answers.c:6:9 in `main`: ReadBit(190): nothing is connected to bit 190: it reads 0 and cannot be written
#include "KMotionDef.h"

main()
{
    if (ReadBit(190)) printf("on\n");
}
