// A function with variable arguments is put in place of its call; what it calls reads them, on every engine.
//@ prints: [1.50 7] 8
//@ prints: [2.50 5] a b 8
#include "KMotionDef.h"
#include <stdarg.h>
#include <stdio.h>

int length;

int say(char *to, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    length = vsprintf(to, format, values);
    va_end(values);
    return length;
}

main()
{
    char text[40], *a = "a";
    int count = say(text, "[%.2f %d]", 1.5, 7);
    printf("%s %d\n", text, count);
    count = say(text, "[%.2f %d]", 2.5, 5);
    printf("%s %s %s %d\n", text, a, "b", count);
}
