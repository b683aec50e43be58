// StartThread runs the same image again: nothing is initialised anew.
//@ args: run --for 0.1
//@ prints: 5
//@ prints: 6
//@ prints: 7
#include "KMotionDef.h"

int n = 5;

main()
{
    printf("%d\n", n++);
    if (n < 8) persist.UserData[0] = 1;
    if (CurrentThread == 1 && n == 6) { again(); }
}

again()
{
    int i;
    for (i = 0; i < 2; i++) printf("%d\n", n++);
}
