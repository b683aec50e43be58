//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    MsgBox("touch plate in place?", MB_YESNO);
}
