// qsort and bsearch call the program's comparison; a function of the program's own wins.
//@ prints: -5 0 1 3 7 9
//@ prints: 3 -1
//@ prints: apple lemon pear
#include "KMotionDef.h"

void qsort(void *base, unsigned count, unsigned size, int (*compare)(const void *, const void *));
void *bsearch(const void *key, const void *base, unsigned count, unsigned size,
              int (*compare)(const void *, const void *));

int strcmp(const char *a, const char *b);
int ascending(const void *a, const void *b) { return *(int *)a - *(int *)b; }
int by_name(const void *a, const void *b) { return strcmp(*(char **)a, *(char **)b); }

int numbers[] = { 7, -5, 9, 0, 3, 1 };
char *fruit[] = { "pear", "apple", "lemon" };

int find(int key)
{
    int *found = bsearch(&key, numbers, 6, sizeof(int), ascending);  //~ vendor-parameter
    return found ? found - numbers : -1;
}

main()
{
    int i;
    qsort(numbers, 6, sizeof(int), ascending);
    for (i = 0; i < 6; i++) printf(i < 5 ? "%d " : "%d\n", numbers[i]);
    printf("%d %d\n", find(3), find(4));
    qsort(fruit, 3, sizeof(char *), by_name);
    printf("%s %s %s\n", fruit[0], fruit[1], fruit[2]);
}
//@ cycles: 28574
