// A loop on a variable that is not volatile sees what another function stored through a pointer.
//@ prints: 3
#include "KMotionDef.h"

int turns;
int *alias = &turns;

main()
{
    int n = 0;
    while (turns < 3) {
        (*alias)++;
        n = turns;
    }
    printf("%d\n", n);
}
//@ cycles: 2510
