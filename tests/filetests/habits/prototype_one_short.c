// A parameter was added to the function and forgotten in the prototype and in a call.
//@ prints: button 3 config 7
#include "KMotionDef.h"

int InitButton(int number, int bit);

main()
{
    InitButton(3, 1024);
}

int InitButton(int number, int bit, int config) //~ prototype-mismatch
{
    config = 7;
    printf("button %d config %d\n", number, config);
    return config;
}
//@ cycles: 7179
