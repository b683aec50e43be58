//@ byte: ␍ 0d
//@ prints: 5 joined
#include "KMotionDef.h"␍
#define FIVE 5 // with a comment␍
#define JOINED \␍
    "joined"␍
␍
main()
{␍
    printf("%d %s\n", FIVE, JOINED);
}␍
//@ cycles: 4936
