//@ prints: -3 ab 3.5
#include "KMotionDef.h"

double y0 = 1.5, y1 = 2.0;

int floor(double x)
{
    int n = x;
    return n > x ? n - 1 : n;
}

int strncpy(char *to, char *from, int n)
{
    int i;
    for (i = 0; i < n; i++) to[i] = from[i];
    return i;
}

main()
{
    char text[8] = "";
    strncpy(text, "abc", 2);
    printf("%d %s %.1f\n", floor(-2.5), text, y0 + y1);
}
//@ cycles: 7739
