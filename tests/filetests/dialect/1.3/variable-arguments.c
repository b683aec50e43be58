//@ prints: 3 2.5 4 x
#include "KMotionDef.h"
#include <stdarg.h>

void show(int n, ...)
{
    va_list list;
    int a, b;
    double d;
    va_start(list, n);
    a = va_arg(list, int);
    d = va_arg(list, double);
    b = va_arg(list, int);
    printf("%d %.1f %d %s\n", a, d, b, va_arg(list, char *));
    va_end(list);
}

main()
{
    show(4, 3, 2.5, 4, "x");
}
//@ cycles: 9471
