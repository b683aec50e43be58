// cc67: run
//
// formats.c - how numbers and texts look on the console.
//
//   cc67 run c-programs/start/formats.c
//
// Expect one line for each kind of value. The bars show where the field begins
// and ends. One call prints 128 characters at most, the rest is lost.

#include "KMotionDef.h"

void Integers(void)
{
    int Counts = -1234;
    unsigned int Status = 0xC0FFEE;

    printf("decimal  |%d|%8d|%-8d|%08d|%+d|\n", Counts, Counts, Counts, Counts, 42);
    printf("hex      |%x|%X|%08X|%#x|\n", Status, Status, Status, Status);
    printf("unsigned |%u|%o|\n", 4000000000u, 8);
}

void Reals(void)
{
    double Inches = 12.34567;
    float Gain = 0.75f;

    printf("fixed    |%f|%10.3f|%-10.3f|%.1f|\n", Inches, Inches, Inches, Inches);
    printf("exponent |%e|%.2e|\n", 12345.678, -0.00123);
    printf("shortest |%g|%g|%g|\n", 2.5, 1e10, 1e-10);
    printf("float    |%f|%.2f|\n", Gain, Gain);
}

void Texts(void)
{
    char Line[40];
    int Length;

    printf("text     |%s|%8s|%-8s|%.2s|%c|\n", "axis", "axis", "axis", "axis", 'X');
    printf("width    |%*d|%.*f|\n", 6, 42, 2, 3.14159);
    printf("percent  |%d%%|\n", 50);

    Length = sprintf(Line, "X%.4f Y%.4f", 1.25, -0.5);
    printf("sprintf  |%s| %d characters\n", Line, Length);
}

// A line may be put together by several calls; it is sent when the newline comes.
void OneLineInPieces(void)
{
    int i;

    printf("pieces   |");
    for (i = 0; i < N_CHANNELS; i++) printf("%d|", i * i);
    printf("\n");
}

main()
{
    Integers();
    Reals();
    Texts();
    OneLineInPieces();
}
