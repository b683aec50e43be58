// The prototype promises an unsigned long, the definition returns an int.
//@ prints: raw 8388607
#include "KMotionDef.h"

unsigned long ReadScale(void);

main()
{
    int raw = ReadScale();
    printf("raw %d\n", raw);
}

int ReadScale(void) //~ prototype-mismatch
{
    int i, value = 0;
    for (i = 0; i < 23; i++) value = (value << 1) | 1;
    return value;
}
//@ cycles: 5028
