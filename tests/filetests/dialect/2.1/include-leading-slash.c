//@ args: run -I parts
//@ prints: first
#include "/KMotionDef.h"
#include "/first/where_else.h"

main() { printf("%s\n", WHERE_ELSE); }
