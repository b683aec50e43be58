// What this test needs of a header with another layout of the axis structure.
#define KMOTION_VER "4.32"
void SetBit(int bit);
typedef struct { double P, I, D; char rest[400]; } CHAN;
extern CHAN chan[8];
