// Two included helpers define the same function; the last counts, for the first helper's calls too.
//@ uses: parts/lamps_new.c
//@ prints: lamp 5 new
//@ prints: lamp 6 new
#include "KMotionDef.h"
#include "parts/lamps_old.c"
#include "parts/lamps_new.c"

main()
{
    OldStart();
    Lamp(6);
}
//@ cycles: 8348
