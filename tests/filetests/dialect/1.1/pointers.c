//@ prints: 4 4 1 44 1
#include "KMotionDef.h"

_Static_assert(sizeof(char *) == 4 && sizeof(void (*)(void)) == 4 && _Alignof(int *) == 4, "pointers");

int value = 0x11223344;
void nothing() { }

main()
{
    unsigned address = (unsigned)nothing;
    void (*again)() = (void (*)())address;
    printf("%d %d %d %x %d\n", sizeof &value, sizeof again, again == nothing, *(char *)&value,
           address >= 0x80050000 && address < 0x80060000);
}
//@ cycles: 10994
