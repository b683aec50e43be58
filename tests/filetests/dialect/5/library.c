//@ prints: 3 abc 0 c 42 -7 1.5 255
#include "KMotionDef.h"

main()
{
    char text[8], *rest;
    memset(text, 0, 8); //~ implicit-declaration: memset
    memcpy(text, "abc", 3); //~ implicit-declaration: memcpy
    printf("%d %s %d %s %d %d ", strlen(text), text, strcmp(text, "abc"), strstr("abc", "c"), atoi("42"), abs(-7) * -1);
    //~^ implicit-declaration: strlen //~^ implicit-declaration: strcmp //~^ implicit-declaration: strstr
    //~^^ implicit-declaration: atoi //~^^ implicit-declaration: abs
    printf("%.1f %d\n", strtod("1.5", &rest), strtol("ff", &rest, 16));
    //~^ implicit-declaration: strtod //~^ implicit-declaration: strtol
}
//@ cycles: 20433
