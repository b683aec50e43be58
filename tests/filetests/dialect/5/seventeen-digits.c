//@ prints: 5
#include "KMotionDef.h"

double values[] = { 0.1, 1.0 / 3, 3.141592653589793, -1234.567, 1e-7 };

main()
{
    char text[40];
    int i, same = 0;
    double back;
    for (i = 0; i < 5; i++) {
        sprintf(text, "%.17g", values[i]);
        if (sscanf(text, "%lf", &back) == 1 && back == values[i]) same++;
    }
    printf("%d\n", same);
}
