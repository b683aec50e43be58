//@ prints: own 7
#include "KMotionDef.h"

int atoi(char *text) { printf("own "); return text[0] - '0'; }

main() { printf("%d\n", atoi("7")); }
//@ cycles: 3636
