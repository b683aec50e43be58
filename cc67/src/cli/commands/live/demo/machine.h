// machine.h - what is connected to which bit.

#define HOME_X  136             // home switches of X, Y, Z, tripped by the axes
#define HOME_Y  137
#define HOME_Z  138
#define START   140             // buttons and switches of the panel
#define DOOR    141
#define ESTOP   142
#define SPINDLE 26              // outputs
#define COOLANT 27
