// Qualifiers, `static` and `*` in the brackets of a parameter; a type whose last word is a macro.
//@ prints: 6 6 2
#include "KMotionDef.h"

#define WORD long

int sum(int list[const], int [*]);
int twice(const int list[static 3]);
int sum(int *const list, int more[restrict 2]) { return list[0] + more[1]; }
int twice(const int list[const 3]) { return 2 * list[2]; }
int half(WORD a, unsigned WORD b) { return b / a; }

main()
{
    int list[3] = { 4, 2, 3 };
    printf("%d %d %d\n", sum(list, list), twice(list), half(2, 4));
}
//@ cycles: 6629
