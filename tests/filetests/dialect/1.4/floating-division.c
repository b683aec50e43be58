//@ prints: 3fd55555 55555555 3eaaaaab
//@ prints: 3fd55555 55555555 3eaaaaab
//@ prints: 1 1
#include "KMotionDef.h"

double one = 1, three = 3, ten = 10;
float single = 1, single_three = 3;
static double third = 1.0 / 3.0;
static float single_third = 1.0f / 3.0f;

void show(double d, float f)
{
    int *halves = (int *)&d;  //~ vendor-parameter
    printf("%x %x %x\n", halves[1], halves[0], *(int *)&f);
}

main()
{
    show(one / three, single / single_three);
    show(third, single_third);
    printf("%d %d\n", one / ten == 0.1, (double)(int)(three / ten * 1e9) == 3e8);
}
//@ cycles: 28094
