// A message is put together with sprintf, changed in place and printed as the format.
//@ prints: Tool 7 of 12
//@ prints: TOOL 7
//@ prints: 3 -1.50 tail
#include "KMotionDef.h"

char s[80]; //~ redeclared

Upper(char *p)
{
    while (*p)
    {
        if (*p >= 'a' && *p <= 'z') *p -= 'a' - 'A';
        p++;
    }
}

main()
{
    double d;
    int n;
    char word[10];

    sprintf(s, "Tool %d of %d\n", 7, 12);
    printf(s);
    s[6] = 0;
    Upper(s);
    printf("%s\n", s);
    sscanf("3 -1.5 tail", "%d %lf %s", &n, &d, word);
    printf("%d %.2f %s\n", n, d, word);
}
//@ cycles: 22046
