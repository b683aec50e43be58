//@ exit: 1
#include "KMotionDef.h"

main()
{
    break; //~ error: break
    continue; //~ error: continue
    case 3: ; //~ error: case
    goto nowhere; //~ error: nowhere
here:
    ;
here: //~ error: here
    ;
}
