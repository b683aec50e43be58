// The vendor's compiler refuses it; the letter stands for itself, as in other compilers.
//@ prints: C:Program
//@ says: for a backslash
#include "KMotionDef.h"

char *path = "C:\Program"; //~ lax-text: \P

main()
{
    printf("%s\n", path);
}
//@ cycles: 3370
