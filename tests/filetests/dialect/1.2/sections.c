//@ prints: 0 0 1 1
#include "KMotionDef.h"

int set = 0;
double also_set = 1.5;
int not_set;

main()
{
    unsigned text = (unsigned)main, data = (unsigned)&set, bss = (unsigned)&not_set;
    printf("%d %d %d %d\n", text % 32, data % 32, text < data && data < bss, (unsigned)&also_set < bss);
}
