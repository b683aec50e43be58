// A call through a pointer without prototype may pass more than the function takes.
//@ prints: 1 3
#include "KMotionDef.h"

int (*called)();
int one(void) { return 1; }
int first(int a) { return a; }

main()
{
    int r;
    called = one;
    r = called(5, 6.0);
    called = first;
    printf("%d %d\n", r, called(3, 4, 5));
}
//@ cycles: 4583
