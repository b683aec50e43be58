// The last turn reads behind the table, where anything may lie.
//@ prints: 7 tools in 8 turns
#include "KMotionDef.h"

#define TOOLS 7

double length[TOOLS] = { 1.5, 2.5, 3.5, 0.5, 0.5, 0.5, 0.5 }, last;

main()
{
    int i, tools = 0, turns = 0;

    for (i = 0; i < TOOLS; i++)
        tools += length[i] > 0;
    for (i = 0; i <= TOOLS; i++) {
        last = length[i]; //~ array-bounds
        turns++;
    }
    printf("%d tools in %d turns\n", tools, turns);
}
//@ cycles: 7474
