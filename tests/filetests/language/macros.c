// The preprocessor: arguments, stringising, pasting, conditionals, include of an included text.
//@ prints: 7 hello x1 = 3
//@ prints: 12 yes
#include "KMotionDef.h"
#define SUM(a, b) ((a) + (b))
#define TEXT(x) #x
#define NAME(n) x##n
#define SHOW(format, ...) printf(format, ## __VA_ARGS__)
#define TWELVE 12 // a comment behind the body

main()
{
    int NAME(1) = 3;
    SHOW("%d %s x1 = %d\n", SUM(3, 4), TEXT(hello), x1);
#if TWELVE > 11 && !defined(NOTHING)
    SHOW("%d yes\n", TWELVE);
#else
    SHOW("no\n");
#endif
}
//@ cycles: 11276
