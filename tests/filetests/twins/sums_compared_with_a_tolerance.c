//@ prints: there 400000
#include "KMotionDef.h"

main()
{
    double x = 0, half = 0;
    float pitch = 1.5;
    int i, counts = 200, mask = 6;
    for (i = 0; i < 10; i++)
    {
        x += 0.1;
        half += 0.5;
    }
    if (x > 0.999 && x < 1.001 && half == 5 && pitch == 1.5 && (!mask) == 0) printf("there ");
    printf("%d\n", counts * 2000);
}
