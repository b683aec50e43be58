#define SPINDLE_CODE 5
#define X_AXIS 0
#define Z_AXIS 2
