//@ args: check
//@ says: warning[sizeof-pointer]: `sizeof(a)` is the size of a pointer
//@ says: size_of_a_parameter.c:9:21
#include "KMotionDef.h"

void Clear(int a[])
{
    int i;
    for (i = 0; i < sizeof(a) / sizeof(int); i++) a[i] = 0;
}

main()
{
    int values[10];
    Clear(values);
}
