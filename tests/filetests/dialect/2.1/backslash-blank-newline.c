//@ byte: ␠ 20
//@ prints: 12
#include "KMotionDef.h"
#define SUM \␠
    (5 + 7)
//~^^ lax-text: backslash

main() { printf("%d\n", SUM); }
//@ cycles: 2760
