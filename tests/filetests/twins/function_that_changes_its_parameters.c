//@ prints: 2 1 15
#include "KMotionDef.h"

void swap(int *a, int *b)
{
    int t = *a;
    *a = *b;
    *b = t;
}

int limited(int value, int most)
{
    if (value > most) value = most;
    return value;
}

void pause(int count)
{
    while (count-- > 0) ;
}

main()
{
    int x = 1, y = 2;
    swap(&x, &y);
    pause(10);
    printf("%d %d %d\n", x, y, limited(20, 15));
}
