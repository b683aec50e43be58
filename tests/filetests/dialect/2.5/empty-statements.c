//@ prints: 3
#include "KMotionDef.h"
;
int n;
next() { return ++n; };

main()
{
    while (next() < 3) ;
    for (;;) { if (n) break; };
    if (n == 7) ; //~ empty-body
    printf("%d\n", n);
    ;
}
;
//@ cycles: 2500
