// A structure among the variable arguments is passed as a copy.
//@ prints: 7 2.5 ab 9 3
//@ prints: 1
#include "KMotionDef.h"

typedef struct { int n; double x; char name[3]; } Tool;
struct Small { char c; };

void show(int count, ...)
{
    va_list list;
    Tool tool;
    int c, last;
    va_start(list, count);
    tool = va_arg(list, Tool);
    c = va_arg(list, struct Small).c;
    last = va_arg(list, int);
    va_end(list);
    tool.n += count;
    printf("%d %.1f %s %d %d\n", tool.n, tool.x, tool.name, c, last);
}

main()
{
    Tool tool = { 1, 2.5, "ab" };
    struct Small small = { 9 };
    show(6, tool, small, 3);
    printf("%d\n", tool.n);
}
//@ cycles: 14236
