//@ byte: ␠ 20
//@ prints: 5
#include "KMotionDef.h␠␠
//~^ lax-text: missing `"`

main() { printf("5\n"); }
//@ cycles: 783
