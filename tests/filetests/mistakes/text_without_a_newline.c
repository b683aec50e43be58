//@ says: the text `done` has no newline: the board keeps it, and the PC never receives it
#include "KMotionDef.h"

main()
{
    printf("done");
}
