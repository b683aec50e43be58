//@ prints: ??/ ??( 2
#include "KMotionDef.h"

main()
{
    char *text = "??=";
    printf("??/ ??( %d\n", text[2] == '=' && text[0] == '?' ? 2 : 0);
}
//@ cycles: 3986
