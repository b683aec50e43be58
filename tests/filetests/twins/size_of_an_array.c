//@ prints: 10 1
#include "KMotionDef.h"

main()
{
    int values[10];
    char *text = "abc";
    printf("%d %d\n", sizeof(values) / sizeof(int), sizeof(*text));
}
