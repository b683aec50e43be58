//@ prints: 44 -1 -31072 210
//@ prints: 44 -1 -31072 210
#include "KMotionDef.h"

double d = 300.7, big = 1e10, sum = 100000 - 65536.0, u = 1234.0;
static char ca = (char)300.7, cbig = (char)1e10;
static short cs = (short)34464.0;
static unsigned char cu = (unsigned char)1234.0;

main()
{
    printf("%d %d %d %d\n", (char)d, (char)big, (short)sum, (unsigned char)u);
    printf("%d %d %d %d\n", ca, cbig, cs, cu);
}
//@ cycles: 21935
