//@ prints: yes no yes 6
#include "KMotionDef.h"

double d = 0.5, zero = 0;
int list[] = { 5, 6, 7 };

main()
{
    double one = 1.9;
    if (d) printf("yes ");
    if (!d) printf("wrong ");
    printf(d && zero ? "wrong " : "no ");
    if (d || zero) printf("yes ");
    printf("%d\n", list[one]); //~ extension
}
//@ cycles: 5789
