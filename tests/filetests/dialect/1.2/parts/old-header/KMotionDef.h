// The part of a header of 4.32 that this test needs.
#define KMOTION_VER "4.32"
void SetBit(int bit);
typedef struct { double Vel, Accel; char rest[408]; } CHAN;
