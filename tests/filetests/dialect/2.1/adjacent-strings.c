//@ prints: one two 8
#include "KMotionDef.h"

char text[] = "one" " "
    "two";

main() { printf("%s %d\n", text, sizeof text); }
//@ cycles: 5104
