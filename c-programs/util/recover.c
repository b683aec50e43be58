// cc67: run
//
// recover.c - back from deep inside to the place where it began.
//
//   cc67 run c-programs/util/recover.c
//
// A sum with parentheses is worked out by functions that call each other. One that
// meets a mistake does not return it through all the others: it jumps back to where
// the line began. `setjmp` returns 0 when it marks the place, and the number of the
// mistake when `longjmp` comes back to it. The place is valid until the function
// that has marked it returns. The vendor's compiler has neither; cc67 brings them.
//
// Expect the value or the mistake of each line.

#include "KMotionDef.h"
#include <setjmp.h>

#define NUMBER_MISSING 1
#define PARENTHESIS_MISSING 2

jmp_buf Line;
char *At;

int Sum(void);

int Number(void)
{
    int Value = 0;

    Delay_sec(0.001);
    if (*At == '(')
    {
        At++;
        Value = Sum();
        if (*At++ != ')') longjmp(Line, PARENTHESIS_MISSING);
        return Value;
    }
    if (*At < '0' || *At > '9') longjmp(Line, NUMBER_MISSING);
    while (*At >= '0' && *At <= '9') Value = 10 * Value + *At++ - '0';
    return Value;
}

int Sum(void)
{
    int Value = Number();

    while (*At == '+')
    {
        At++;
        Value += Number();
    }
    return Value;
}

void Show(char *Text)
{
    int Mistake;

    At = Text;
    Mistake = setjmp(Line);
    if (Mistake == 0) printf("%s = %d\n", Text, Sum());
    else if (Mistake == NUMBER_MISSING) printf("%s: a number is missing at %d\n", Text, At - Text + 1);
    else printf("%s: a parenthesis is missing\n", Text);
}

main()
{
    Show("1+(2+3)+4");
    Show("1+((2+)+4)");
    Show("1+((2+3)+4");
    Show("((((((((5))))))))");
}
