//@ prints: 12 4 97 98 0
#include "KMotionDef.h"

_Static_assert(sizeof L"ab" == 12 && sizeof L'a' == 4, "wide characters");

int text[] = L"ab";

main()
{
    printf("%d %d %d %d %d\n", sizeof text, sizeof L'a', text[0], L"ab"[1], text[2]);
}
//@ cycles: 11598
