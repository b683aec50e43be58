//@ prints: 1 4 8
#include "KMotionDef.h"

char first = 1;
int second = 2;
double third = 3;

main()
{
    printf("%d %d %d\n", (char *)&second > &first && (char *)&third > (char *)&second,
           (char *)&second - &first, (char *)&third - &first);
}
//@ cycles: 6632
