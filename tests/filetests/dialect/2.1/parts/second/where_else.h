#define WHERE_ELSE "second"
