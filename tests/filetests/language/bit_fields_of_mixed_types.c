// Bit-fields of mixed types, and members between them, lie as gcc places them: each follows the bit before it, unless it would
// straddle a unit of its type.
//@ prints: 4 4 4 8 4
//@ prints: ff ff 07 00
//@ prints: 00 00 00 ff
//@ prints: 5f 40 80 e1
//@ prints: 05 07 03 00
//@ prints: -1 255 15 1000 -1 5 7 3
#include "KMotionDef.h"

struct { int position : 19; unsigned char state : 8; } drive, other;
struct { unsigned char mode : 4; int count : 19; short change : 9; } encoder = { 15, 1029, -61 };
struct { int first : 5; char whole; int last : 3; } parts = { 5, 7, 3 };
struct { int large : 24; int next : 9; unsigned char rest : 7; } wide;
struct { short low : 9; int middle : 9; signed char high : 3; } mixed;

void show(void *object)
{
    unsigned char *bytes = object;
    printf("%02x %02x %02x %02x\n", bytes[0], bytes[1], bytes[2], bytes[3]);
}

main()
{
    printf("%d %d %d %d %d\n", sizeof drive, sizeof encoder, sizeof parts, sizeof wide, sizeof mixed);
    drive.position = -1;
    show(&drive);
    other.state = 255;
    show(&other);
    show(&encoder);
    show(&parts);
    encoder.count = 1000;
    encoder.change = -1;
    printf("%d %d %d %d %d %d %d %d\n", drive.position, other.state, encoder.mode, encoder.count, encoder.change, parts.first,
           parts.whole, parts.last);
}
