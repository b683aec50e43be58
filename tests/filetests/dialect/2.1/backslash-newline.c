//@ prints: 12 ab
#include "KMotionDef.h"
#define SUM(a, b) \
    ((a) + \
     (b))

main()
{
    int lo\
ng_name = SUM(5, 7);
    printf("%d a\
b\n", long_name);
}
//@ cycles: 3321
