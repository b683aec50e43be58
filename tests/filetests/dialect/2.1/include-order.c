//@ args: run -I parts/first -I parts/second
//@ prints: first found
#include "KMotionDef.h"
#include "where_else.h"
#include "only_second.h"

main() { printf("%s %s\n", WHERE_ELSE, ONLY_SECOND); }
