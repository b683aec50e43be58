//@ prints: 41 0
#include "KMotionDef.h"

void with() { return 65; }
void without() { }

main()
{
    printf("%X %d\n", with(), without()); //~ void-value //~ void-value
}
//@ cycles: 4776
