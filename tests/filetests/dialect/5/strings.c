//@ prints: [abc] [  abc] [ab]
//@ prints: as it is
#include "KMotionDef.h"

char text[] = "as it is\n";

main()
{
    printf("[%s] [%5s] [%.2s]\n", "abc", "abc", "abc");
    printf(text);
}
//@ cycles: 9736
