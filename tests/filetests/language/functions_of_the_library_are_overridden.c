// A program's own function wins over the library's, which takes the rest from its own.
//@ prints: 1 hello
#include "KMotionDef.h"

int isdigit(int c) { return 1; }
char *strcpy(char *to, const char *from);

main()
{
    char text[10];
    strcpy(text, "hello");
    printf("%d %s\n", isdigit('x'), text);
}
//@ cycles: 4820
