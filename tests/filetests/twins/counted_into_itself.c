//@ prints: 6 parts
#include "KMotionDef.h"

main()
{
    int part = 0, last = 0;
    while (part < 6) last = part++;
    part = last + 1;
    printf("%d parts\n", part);
}
