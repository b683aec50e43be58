//@ prints: 8 97 98
#include "KMotionDef.h"

int text[] = L"a", one = L'b';

main() { printf("%d %d %d\n", sizeof text, text[0], one); }
//@ cycles: 7179
