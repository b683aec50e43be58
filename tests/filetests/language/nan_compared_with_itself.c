//@ prints: 1
// A NaN is not at least itself, on whatever way it comes to the comparison. GCC 12 says so at -O0 only.
#include "KMotionDef.h"

int hit;
double zero;
float a, g;

void count(double q)
{
    short v = q > -1e6 && q < 1e6 ? 0 : 7;
    int i = 0;
    for (; i != 1; ++i)
        switch ((v * (a != -0.0625)) & 7) { case 0: g -= i; case 1: q = 0; }  //~ fall-through
    switch ((q >= q) % 5 & 7) { case 0: hit++; case 1: zero = 0; }  //~ self-comparison
    //~^ fall-through
}

main()
{
    count(zero / zero);
    printf("%d\n", hit);
}
//@ cycles: 2563
