//@ prints: 4 0.100000001490116 2 -56
#include "KMotionDef.h"

void show(float f, int i, char c) { printf("%d %.15f %d %d\n", sizeof f, f, i, c); }

main()
{
    show(0.1, 2.9, 200); //~ lost-fraction
}
//@ cycles: 14337
