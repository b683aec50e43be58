//@ prints: 3 4
#include "KMotionDef.h"

main()
{
    int n = 0;
    switch (1) {
    case 1:
        int a = 3;
        n = a;
    }
    goto next;
next:
    int b = 4;
    printf("%d %d\n", n, b);
}
//@ cycles: 4551
