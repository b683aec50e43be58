// The board leaves the value in the result register, and programs use it.
//@ prints: 41
//@ says: void
#include "KMotionDef.h"

void Next() { return 65; }

main()
{
    printf("%X\n", Next());
}
//@ cycles: 2707
