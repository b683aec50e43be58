// The part of a header of 4.32 that this test needs.
#define KMOTION_VER "4.32"
void SetBit(int bit);
typedef struct { int InputMode, ChanNumber; double Dest; char rest[408]; } CHAN;
extern CHAN chan[8];
