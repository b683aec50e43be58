#include "KMotionDef.h"

int square(int side)
{
    int area = side * side;
    return area;
}

main()
{
    int side, sum = 0;
    for (side = 1; side < 5; side++)
        sum += square(side);
    printf("sum %d\n", sum);
}
