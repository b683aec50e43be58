// MySpindleDefs.h - included by the spindle programs: what this machine's spindle is.
//
// Everything that differs from machine to machine stands here, so the programs for M3,
// M4, M5 and S need no change.

#ifndef MY_SPINDLE_DEFS_H
#define MY_SPINDLE_DEFS_H

#define SPINDLE_AXIS    6           // the axis that drives it
#define COUNTS_PER_TURN 1000.0      // of that axis
#define MAX_RPM         6000.0f
#define RAMP            2000.0f     // turns per minute gained or lost in a second

#define CW              1
#define OFF             0
#define CCW             (-1)

#define STATE_VAR       98          // persist: CW, OFF or CCW
#define SPEED_VAR       99          // persist: turns per minute, a float
#define S_VAR           113         // persist: where the PC puts the number behind S, a float

#endif
