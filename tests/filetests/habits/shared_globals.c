// A file that is included declares what the program defines.
//@ prints: 3 parts, 7.50 mm
#include "KMotionDef.h"
#include "parts/counting.c"

volatile int Parts;
double Length;

main()
{
    Count(2.5);
    Count(2.5);
    Count(2.5);
    printf("%d parts, %.2f mm\n", Parts, Length);
}
//@ cycles: 8005
