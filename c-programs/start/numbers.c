// cc67: run
//
// numbers.c - what the board's number types can hold, and where they bite.
//
//   cc67 run c-programs/start/numbers.c
//
// Expect the sizes of the types, integer divisions that cut off, conversions
// that cut off or wrap, and a float that cannot hold a large position.

#include "KMotionDef.h"

void Sizes(void)
{
    printf("bytes: char %d, short %d, int %d, long %d, float %d, double %d, pointer %d\n",
           (int)sizeof(char), (int)sizeof(short), (int)sizeof(int), (int)sizeof(long),
           (int)sizeof(float), (int)sizeof(double), (int)sizeof(int *));
}

// Two whole numbers make a whole number, also when the result goes to a double.
void Divisions(void)
{
    int Counts = 7, PerTurn = 2;
    double Turns = Counts / PerTurn;
    double Exact = (double)Counts / PerTurn;

    printf("7/2 = %f, (double)7/2 = %f\n", Turns, Exact);
    printf("-7/2 = %d, -7%%2 = %d\n", -Counts / PerTurn, -Counts % PerTurn);
}

void Conversions(void)
{
    unsigned char Register = (unsigned char)(200 + 100);
    signed char Difference = (signed char)(130 - 4);
    short Half = (short)40000;

    printf("(int)2.7 = %d, (int)-2.7 = %d, rounded = %d\n", (int)2.7, (int)-2.7, (int)(2.7 + 0.5));
    printf("300 in a byte = %d, 126 in a char = %d, 40000 in a short = %d\n", Register, Difference, Half);
}

// A float has 24 bits: beyond 16777216 it cannot count single steps any more.
void LargePositions(void)
{
    float AsFloat = 16777216.0f;
    double AsDouble = 16777216.0;

    AsFloat = AsFloat + 1.0f;
    AsDouble = AsDouble + 1.0;
    printf("16777216 + 1: float %.0f, double %.0f\n", AsFloat, AsDouble);
}

void Bits(void)
{
    unsigned int Word = 0x12345678;

    printf("high byte %02X, low 16 bits %04X, shifted sign %d\n",
           Word >> 24, Word & 0xFFFF, -256 >> 4);
}

main()
{
    Sizes();
    Divisions();
    Conversions();
    LargePositions();
    Bits();
}
