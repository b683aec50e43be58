//@ prints: 1 1 1
#include "KMotionDef.h"

int list[4];
void f() { }

main()
{
    void *p = list;
    p = p + 1;
    printf("%d %d %d\n", sizeof(void), sizeof f, (char *)p - (char *)list);
}
//@ cycles: 6622
