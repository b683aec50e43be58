//@ prints: Xbc abc 0
#include "KMotionDef.h"

char *a = "abc", *b = "abc";

main()
{
    a[0] = 'X';
    printf("%s %s %d\n", a, b, a == b);
}
//@ cycles: 6388
