//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

duoble position;
flaot speed = 2.5;

main()
{
    position = ch0->Position * speed;
}
