// cc67: run
//
// raster.c - engraving a picture line by line: the beam follows a pattern while the head moves.
//
//   cc67 run c-programs/laser/raster.c
//
// Each line of the picture is one move at constant speed, forward and back in turn. While
// it lasts, the position tells which dot of the line is due. The head needs a run-up on
// either side, or the first and last dots would be burned while it is still slow.
//
// The program writes down where the beam was on, which must be the picture again.
//
// Expect the letters twice, the second time as burned.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define X      0
#define Y      1
#define BEAM   46                   // an output; its LED shows the beam
#define DOTS   17
#define LINES  5
#define DOT    100.0                // steps
#define RUN_UP 500.0
#define FEED   10000.0f

char *Picture[LINES] =
{
    "#..#.#..#.###...#",
    "#.#..##.#.#..#.#.",
    "##...####.#..#...",
    "#.#..#.##.#..#.#.",
    "#..#.#..#.###...#"
};

char Burned[LINES][DOTS + 1];

// The dot at a position, or -1 outside the picture.
int DotAt(double Position)
{
    return Position >= 0.0 && Position < DOTS * DOT ? (int)(Position / DOT) : -1;
}

void Engrave(int Line)
{
    int Dot, IsOn;

    MoveAtVel(X, Line % 2 ? -RUN_UP : DOTS * DOT + RUN_UP, FEED);
    while (!CheckDone(X))
    {
        Dot = DotAt(chan[X].Dest);
        IsOn = Dot >= 0 && Picture[Line][Dot] == '#';
        SetStateBit(BEAM, IsOn);
        if (Dot >= 0) Burned[Line][Dot] = ReadBit(BEAM) ? '#' : '.';
        WaitNextTimeSlice();
    }
    ClearBit(BEAM);
    MoveRel(Y, DOT);
    WaitForAxis(Y);
}

main()
{
    int i;

    SetBitDirection(BEAM, 1);
    SetupStepAxis(X, 20000.0f, 200000.0f, 4e6f);
    SetupStepAxis(Y, 20000.0f, 200000.0f, 4e6f);
    Move(X, -RUN_UP);
    WaitForAxis(X);

    for (i = 0; i < LINES; i++) printf("%s\n", Picture[i]);
    for (i = 0; i < LINES; i++) Engrave(i);
    for (i = 0; i < LINES; i++) printf("%s\n", Burned[i]);
}
