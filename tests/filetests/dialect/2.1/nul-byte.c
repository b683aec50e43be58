//@ byte: ␀ 00
//@ exit: 1
#include "KMotionDef.h"

main()
{
    int a␀ = 5; //~ error: NUL
}
