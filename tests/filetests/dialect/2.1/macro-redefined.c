//@ prints: 5 6 7
#include "KMotionDef.h"
#define A 5
#define B 7
#define B 7

main()
{
    printf("%d ", A);
#define A 6 //~ macro-redefined: A
    printf("%d %d\n", A, B);
}
//@ cycles: 7027
