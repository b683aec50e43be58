#include "KMotionDef.h"

main()
{
    SetFRO(0.5);
    SetRapidFRO(1.5);
}
