#define WHERE_ELSE "first"
