//@ prints: 1 1 4 4 4 yes
#include "KMotionDef.h"
#if defined linux || defined unix || defined __linux__ || defined _WIN32 || defined __x86_64__ || defined __GNUC__
#error host macros
#endif
#ifdef __CC67__
#define CC67 "yes"
#endif

__SIZE_TYPE__ a;
__PTRDIFF_TYPE__ b;
__WCHAR_TYPE__ c;

main() { printf("%d %d %d %d %d %s\n", __STDC__, __TINYC__, sizeof a, sizeof b, sizeof c, CC67); }
//@ cycles: 12709
