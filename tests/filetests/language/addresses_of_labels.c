// `&&label` and `goto *`: a table of steps, offsets between labels, a label in a static object.
//@ prints: start home move home stop
//@ prints: 2 1
#include "KMotionDef.h"

char program[] = { 0, 1, 2, 1, 3 };

void interpret(char *step)
{
    static void *table[] = { &&start, &&home, &&move, &&stop };
    goto *table[*step];
start:
    printf("start ");
    goto *table[*++step];
home:
    printf("home ");
    goto *table[*++step];
move:
    printf("move ");
    goto *table[*++step];
stop:
    printf("stop\n");
}

int choose(int second)
{
    static int offsets[] = { &&one - &&one, &&two - &&one };
    void *to = &&one + offsets[second];
    goto *to;
one:
    return 1;
two:
    return 2;
}

main()
{
    interpret(program);
    printf("%d %d\n", choose(1), choose(0));
}
//@ cycles: 11495
