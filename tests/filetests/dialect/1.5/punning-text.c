//@ prints: G1X2 4
#include "KMotionDef.h"

main()
{
    char *p = (char *)gather_buffer + 100;
    int n = 0;
    p[0] = 'G'; p[1] = '1'; p[2] = 'X'; p[3] = '2'; p[4] = 0;
    while (p[n]) n++;
    printf("%s %d\n", (char *)gather_buffer + 100, n);
}
//@ cycles: 4631
