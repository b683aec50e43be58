//@ prints: ab 2 1.5 7 8 9
#include "KMotionDef.h"

double y0 = 1.5;
int s = 7; //~ redeclared
int bb = 8; //~ redeclared
int GET = 9; //~ redeclared

int strncpy(char *to, char *from, int n) { while (n-- > 0) *to++ = *from++; return 0; }
int floor(double x) { return x; }

main()
{
    char text[4] = "";
    strncpy(text, "abc", 2);
    printf("%s %d %.1f %d %d %d\n", text, floor(2.9), y0, s, bb, GET);
}
//@ cycles: 13764
