// Installs a call-back and ends.
#include "KMotionDef.h"

void count(void) { persist.UserData[7]++; }

main() { UserCallBack = count; }
