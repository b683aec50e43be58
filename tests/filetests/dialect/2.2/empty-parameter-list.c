//@ prints: 5 5 5
#include "KMotionDef.h"

five() { return 5; }
int later();

main()
{
    printf("%d %d %d\n", five(), five(1, 2), later(3)); //~ extra-arguments
}

int later(int n) { return n + 2; }
//@ cycles: 6629
