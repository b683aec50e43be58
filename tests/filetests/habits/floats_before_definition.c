// A function with floats is called above its definition: the board would pass garbage.
//@ prints: move to 12.50 at 3.00
#include "KMotionDef.h"

main()
{
    MoveToPocket(12.5, 3); //~ implicit-declaration: called before it is declared
}

MoveToPocket(float position, float speed)
{
    printf("move to %.2f at %.2f\n", position, speed);
}
//@ cycles: 10210
