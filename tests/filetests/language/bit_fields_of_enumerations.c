// A bit-field of an enumeration holds all its constants: unsigned if none is negative.
//@ prints: 3 200 -1
//@ prints: 3 1
#include "KMotionDef.h"

enum state { IDLE, HOMING, MOVING, FAULT };
typedef enum { SMALL = 1, LARGE = 200 } Size;
enum direction { BACK = -1, NONE, FORTH };
typedef enum state State;

struct axis { enum state state : 2; Size size : 8; enum direction direction : 2; };
struct other { State state : 2; enum { OFF, ON } power : 1; };

main()
{
    struct axis a;
    struct other o;
    a.state = FAULT;
    a.size = LARGE;
    a.direction = BACK;
    printf("%d %d %d\n", a.state, a.size, a.direction);
    o.state = FAULT;
    o.power = ON;
    printf("%d %d\n", o.state, o.power);
}
//@ cycles: 11919
