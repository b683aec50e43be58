//@ prints: 3 44 1
#include "KMotionDef.h"

int unused;

helper(int a, int b) { a = b; } //~ parameter-copy

void main()
{
    int n = 3.7, never; //~ lost-fraction
    char c = 300; //~ constant-conversion
    unsigned u = 1;
    helper(n, c);
    printf("%d %d %d\n", n, c, n > u);
}
//@ cycles: 6899
