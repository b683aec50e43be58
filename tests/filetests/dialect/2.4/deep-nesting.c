//@ prints: 1 700
#include "KMotionDef.h"
#define P10(x) ((((((((((x))))))))))
#define P100(x) P10(P10(P10(P10(P10(P10(P10(P10(P10(P10(x))))))))))
#define S10(x) x + x + x + x + x + x + x + x + x + x
#define S700 S10(S10(7 * 1))

main()
{
    int one = 1;
    printf("%d %d\n", P100(P100(P100(P100(P100(P100(one)))))), S700);
}
//@ cycles: 5109
