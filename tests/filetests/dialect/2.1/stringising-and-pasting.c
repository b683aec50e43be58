//@ prints: a+b a + b 12 x,y 3 named 4
#include "KMotionDef.h"
#define TEXT(x) #x
#define ALL(...) #__VA_ARGS__
#define JOIN(a, b) a##b
#define SHOW(format, ...) printf(format, ## __VA_ARGS__)
#define NAMED(format, rest...) printf(format, ## rest)

main()
{
    SHOW("%s %s %d %s ", TEXT(a+b), TEXT(a  +  b), JOIN(1, 2), ALL(x,y));
    SHOW("3 ");
    NAMED("named ");
    NAMED("%d\n", 4);
}
//@ cycles: 13733
