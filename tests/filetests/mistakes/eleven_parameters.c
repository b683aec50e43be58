//@ args: check
//@ says: warning[vendor-parameter]: the vendor's compiler cannot pass the 11 parameters of `Sum`
//@ says: eleven_parameters.c:6:5
#include "KMotionDef.h"

int Sum(int a, int b, int c, int d, int e, int f, int g, int h, int i, int j, int k)
{
    return a + b + c + d + e + f + g + h + i + j + k;
}

main()
{
    printf("%d\n", Sum(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
}
