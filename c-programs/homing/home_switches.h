// home_switches.h - what home3.c and home_switches.c agree on.

#define SWITCH_BIT 1024     // virtual bits: the switches of axes 0, 1 and 2
#define HOMING_END 1031     // virtual bit: the homing has finished

#define SWITCH_AT  70       // persist: machine positions of the three switches
#define MACHINE_AT 73       // persist: machine positions of the three axes
#define ZERO_AT    76       // persist: where home3.c found the zero points
