//@ prints: go
#include "KMotionDef.h"

char command[20] = "GO";

int Same(char *a, char *b)
{
    while (*a && *a == *b) a++, b++;
    return *a == *b;
}

main()
{
    if (Same(command, "GO")) printf("go\n");
}
