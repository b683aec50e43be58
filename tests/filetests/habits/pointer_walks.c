// Pointers run along characters and numbers.
//@ prints: 6 words, 17 letters
//@ prints: largest 9 at 3
#include "KMotionDef.h"

char text[] = "do not touch the red key";
int numbers[] = { 3, 7, 1, 9, 2 };

main()
{
    char *p = text;
    int *q = numbers, *best = numbers, words = 1, letters = -2;

    while (*p)
    {
        if (*p++ == ' ') words++;
        else letters++;
    }
    while (q < numbers + 5)
    {
        if (*q > *best) best = q;
        q++;
    }
    printf("%d words, %d letters\n", words, letters);
    printf("largest %d at %d\n", *best, best - numbers);
}
//@ cycles: 14487
