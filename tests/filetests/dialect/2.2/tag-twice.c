//@ exit: 1
#include "KMotionDef.h"

struct Same { int a; double b; };
struct Same { int a; double b; };
struct Other { int a; };
struct Other { double a; }; //~ error: Other

main() { }
