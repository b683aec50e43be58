//@ prints: 1.500000 -3 200
#include "KMotionDef.h"

void show();

main()
{
    float f = 1.5f;
    char c = -3;
    unsigned char u = 200;
    show(f, c, u);
}

void show(double d, int i, int j) { printf("%f %d %d\n", d, i, j); }
//@ cycles: 9798
