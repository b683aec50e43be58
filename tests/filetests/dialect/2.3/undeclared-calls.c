//@ prints: 7 b 200
#include "KMotionDef.h"

char text[] = "abc";

main()
{
    printf("%d %c %d\n", add(3, 4), *at(text, 1), narrow(200));
    nothing(5);
}

add(int a, int b) { return a + b; }
char *at(char *p, int n) { return p + n; }
unsigned short narrow(int n) { return n; }
void nothing(int n) { }
//@ cycles: 6837
