//@ prints: 0 0 1 1
#include "KMotionDef.h"

int set = 0;
double also_set = 1.5;
int not_set;

main()
{
    unsigned text = (unsigned)main, data = (unsigned)&set, bss = (unsigned)&not_set;
    /* The return before bytecode takes 16 bytes. */
    printf("%d %d %d %d\n", text % 16, data % 32, text < data && data < bss, (unsigned)&also_set < bss);
}
//@ cycles: 8733
