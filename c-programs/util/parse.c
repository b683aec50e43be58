// cc67: run
//
// parse.c - taking commands and numbers out of lines of text.
//
//   cc67 run c-programs/util/parse.c
//
// sscanf returns how many values it found; a program that does not look at that
// number works on with old ones. The board has no strcmp, so the program brings its own.
//
// Expect three lines understood and three refused with a reason, then a hexadecimal
// number and the parts of a date.

#include "KMotionDef.h"

#define LINES 6

char *Line[LINES] =
{
    "MOVE 2 1250.5",
    "SPEED 1 40",
    "STOP",
    "MOVE 2",
    "MOVE 9 100",
    "JUMP 1 1"
};

int Same(char *a, char *b)
{
    while (*a && *a == *b)
    {
        a++;
        b++;
    }
    return *a == *b;
}

void Obey(char *Text)
{
    char Word[20];
    int Axis = 0;
    double Value = 0.0;
    int n = sscanf(Text, "%s %d %lf", Word, &Axis, &Value);

    if (n >= 1 && Same(Word, "STOP")) printf("stopped\n");
    else if (n < 3) printf("'%s': a number is missing\n", Text);
    else if (Axis < 0 || Axis >= N_CHANNELS) printf("'%s': no axis %d\n", Text, Axis);
    else if (Same(Word, "MOVE")) printf("axis %d to %.1f\n", Axis, Value);
    else if (Same(Word, "SPEED")) printf("axis %d at %.1f\n", Axis, Value);
    else printf("'%s': not known\n", Text);
}

main()
{
    int i, Hex, Year, Month;

    for (i = 0; i < LINES; i++) Obey(Line[i]);

    sscanf("0x1F", "%x", &Hex);
    sscanf("2024-05", "%4d-%d", &Year, &Month);
    printf("hex %d, month %d of %d\n", Hex, Month, Year);
}
