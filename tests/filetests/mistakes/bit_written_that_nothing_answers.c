//@ says: thread 1 at bit_written_that_nothing_answers.c:6:5 in `main`: SetStateBit(200): nothing is connected to bit 200: it reads 0 and cannot be written
#include "KMotionDef.h"

main()
{
    SetStateBit(200, 1);
}
