// What a controlling expression declares ends with its statement.
//@ prints: 2 1 3 1 4 1 1
#include "KMotionDef.h"

enum { LEVEL = 1 };

main()
{
    int a, b, c, d, e, f;
    if (sizeof(enum { LEVEL = 2 })) a = LEVEL;
    b = LEVEL;
    while (sizeof(enum { LEVEL = 3 })) { c = LEVEL; break; }
    d = LEVEL;
    switch (sizeof(enum { LEVEL = 4 })) { default: e = LEVEL; }
    f = LEVEL;
    do ; while (!sizeof(enum { LEVEL = 5 }));
    printf("%d %d %d %d %d %d %d\n", a, b, c, d, e, f, LEVEL);
}
//@ cycles: 14898
