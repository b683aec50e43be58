//@ prints: a b c range other 
//@ prints: end
#include "KMotionDef.h"

void show(int n)
{
    switch (n) {
    case 1: printf("a ");
    case 2: printf("b ");
    case 3: printf("c "); break;  //~ fall-through
    //~^^ fall-through
    case 10 ... 15: printf("range "); break;
    default: printf("other ");
    }
}

main()
{
    show(1);
    show(12);
    show(16);
    printf("\n");
    switch (5) {
    case 4: printf("wrong\n");
    case 5:  //~ fall-through
    }
    goto end;
    printf("wrong\n"); //~ unreachable-code
end:
    printf("end\n");
    goto last;
last:
}
//@ cycles: 7146
