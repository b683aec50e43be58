// The value of a range of designators is computed once, whatever it does.
//@ prints: 1 1 1 2 2
#include "KMotionDef.h"

int calls;
int next() { return ++calls; }

main()
{
    int list[5] = { [0 ... 2] = next(), [3 ... 4] = ++calls };
    printf("%d %d %d %d %d\n", list[0], list[1], list[2], list[3], list[4]);
}
//@ cycles: 10772
