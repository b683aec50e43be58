//@ prints: 1000000000000 -3
//@ prints: 80000000 4 1
#include "KMotionDef.h"

long long big = 1000000;
unsigned long long wide = 0x8000000000000000ull;

main()
{
    long long product = big * big;
    char text[30];
    int high = (int)(product / 1000000), low = (int)(product % 1000000);
    sprintf(text, "%d%06d", high, low);
    printf("%s %d\n", text, (int)(-7ll / 2));
    printf("%x %d %d\n", (int)(wide >> 32), sizeof(long long) / 2, wide > 1);
}
//@ cycles: 19474
