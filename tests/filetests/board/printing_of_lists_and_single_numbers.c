// The functions that print a list of arguments, and those that print one number. Halves are
// rounded away from zero, as was measured.
//@ prints: 7 axes 0.13
//@ prints: 12
//@ prints:   3.3|12  |ff 13
//@ prints:   3.3 13
//@ prints: -2147483647 11
//@ prints:    2.500
//@ prints: 0042
#include "KMotionDef.h"
#include <stdarg.h>

int vprintf(const char *format, va_list list);
int vsprintf(char *to, const char *format, va_list list);
int vsnprintf(char *to, unsigned room, const char *format, va_list list);
int ltoa(long value, char *to);

char text[40];

static int show(const char *format, ...)
{
    va_list list;
    int count;

    va_start(list, format);
    count = vprintf(format, list);
    va_end(list);
    return count;
}

static int write(char *to, unsigned room, const char *format, ...)
{
    va_list list;
    int count;

    va_start(list, format);
    count = room ? vsnprintf(to, room, format, list) : vsprintf(to, format, list);
    va_end(list);
    return count;
}

main()
{
    int count;

    count = show("%d %s %.2f\n", 7, "axes", 0.125);
    printf("%d\n", count);
    count = write(text, 0, "%5.1f|%-4d|%x", 3.25, 12, 255);
    printf("%s %d\n", text, count);
    count = write(text, 6, "%5.1f|%-4d|%x", 3.25, 12, 255);
    printf("%s %d\n", text, count);
    count = ltoa(-2147483647, text);
    printf("%s %d\n", text, count);
    PrintFloat("%8.3f\n", 2.5);
    PrintInt("%04d\n", 42);
}
//@ cycles: 62998
