// Prefixes u8, u, U and L, escapes \u and \U; text without prefix stays as its bytes are.
//@ prints: 3 4 12 8 8
//@ prints: e9 20ac 1f600 d83d
//@ prints: 195 169 226 130 172
//@ prints: 2 4 4 233 65
#include "KMotionDef.h"

unsigned short half[] = u"\u00e9€😀";
unsigned full[] = U"é\u20ac\U0001F600";
int wide[] = L"é" "x";

main()
{
    char *text = "\u00e9€";
    printf("%d %d %d %d %d\n", sizeof(u8"é"), sizeof(u"a"), sizeof(L"ab"), sizeof(half) - 2, sizeof(full) - 8);
    printf("%x %x %x %x\n", half[0], full[1], full[2], half[2]);
    printf("%d %d %d %d %d\n", text[0] & 255, text[1] & 255, text[2] & 255, text[3] & 255, text[4] & 255);
    printf("%d %d %d %d %d\n", sizeof(u'a'), sizeof(U'a'), sizeof(L'a'), wide[0], L'A');
}
//@ cycles: 47486
