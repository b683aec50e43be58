// Functions from a book of 1985.
//@ prints: 12.50 0.10 c
#include "KMotionDef.h"

double scaled(value, factor) //~ old-style-definition
double value;
float factor;
{
    return value * factor;
}

pick(text, n) //~ old-style-definition
char *text;
{
    return text[n];
}

main()
{
    printf("%.2f %.2f %c\n", scaled(5.0, 2.5), scaled(0.04, 2.5), pick("abc", 2));
}
//@ cycles: 9676
