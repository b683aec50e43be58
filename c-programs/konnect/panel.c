// cc67: run
//
// panel.c - four Konnect boards on one port: lamps show the buttons below them.
//
//   cc67 run --stim c-programs/konnect/panel.stim c-programs/konnect/panel.c
//
// Each board has 16 outputs and 32 inputs. The board's service copies them from and to
// words of the program's choice, one board in each servo tick, so that four boards take
// four ticks. The words used here are those of the virtual bits, which makes every input
// and output a numbered bit.
//
// The file beside this program presses a button on board 3 and on board 0. Expect both,
// and the time that the second one took.

#include "KMotionDef.h"

#define BOARDS 4

// Words of the extended virtual bits: outputs of a board, then its inputs.
#define OUT(b) (VirtualBitsEx + 2 * (b))
#define IN(b)  (VirtualBitsEx + 2 * (b) + 1)

main()
{
    int Board, Before[BOARDS], Seen = 0;

    InitAux();
    for (Board = 0; Board < BOARDS; Board++)
    {
        AddKonnect(Board, OUT(Board), IN(Board));
        Before[Board] = 0;
    }

    while (Seen < 3)
    {
        WaitNextTimeSlice();
        for (Board = 0; Board < BOARDS; Board++)
        {
            if (*IN(Board) == Before[Board]) continue;
            printf("%.1f ms: board %d inputs %08X\n", Time_sec() * 1e3, Board, *IN(Board));
            Before[Board] = *IN(Board);
            *OUT(Board) = *IN(Board) & 0xFFFF;
            Seen++;
        }
    }
    printf("lamp below button 4 of board 3: %d\n", ReadBit(1024 + 32 * 6 + 4));
    InitAux();
}
