//@ prints: one two, three
//@ prints: 
//@ prints: four
#include "KMotionDef.h"

main()
{
    printf("one ");
    printf("two, ");
    printf("three\n\nfo");
    printf("ur\n");
}
//@ cycles: 5554
