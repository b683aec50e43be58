// Names that the library or the firmware has, too: the program's own are meant.
//@ prints: T05 -2 3 y 7.00 -1.50 s 9
#include "KMotionDef.h"

double y0 = 7, y1 = -1.5;
int s = 9; //~ redeclared

int floor(double x)
{
    int i = (int)x;
    if (x < 0 && i != x) i--;
    return i;
}

int strncpy(char *d, char *t, int n)
{
    int i;
    for (i = 0; i < n && t[i]; i++) d[i] = t[i];
    d[i] = 0;
    return i;
}

main()
{
    char name[20];
    int n = strncpy(name, "T05 END", 3);
    printf("%s %d %d y %.2f %.2f s %d\n", name, floor(-1.2), n, y0, y1, s);
}
//@ cycles: 16831
