// Doubles go into ints and floats without a cast, ints into characters.
//@ prints: 1499 0.100000001 -56 65535 12
#include "KMotionDef.h"

int Steps(double mm, double steps)
{
    int n = mm * steps;
    return n;
}

main()
{
    float f = 0.1;
    char c = 200;
    unsigned short u = -1;
    int rpm = 5;
    rpm *= 2.5;
    printf("%d %.9f %d %d %d\n", Steps(1.4999, 1000), f, c, u, rpm);
}
//@ cycles: 16837
