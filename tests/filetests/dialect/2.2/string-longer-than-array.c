//@ prints: abc
#include "KMotionDef.h"

char text[3] = "abcdef"; //~ long-string

main() { printf("%c%c%c\n", text[0], text[1], text[2]); }
//@ cycles: 5101
