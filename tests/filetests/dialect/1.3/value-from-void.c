//@ prints: 65 66
#include "KMotionDef.h"

void first() { return 65; }
void second() { return first() + 1; } //~ void-value

main()
{
    int n = first(); //~ void-value
    printf("%d %d\n", n, second()); //~ void-value
}
//@ cycles: 5117
