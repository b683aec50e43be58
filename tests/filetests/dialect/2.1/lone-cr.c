//@ byte: ␍ 0d
//@ prints: 3 8
#include "KMotionDef.h"
␍int␍a = 3;␍

main()
{␍
    printf("%d %d\n",␍a, __LINE__);␍
}
//@ cycles: 4551
