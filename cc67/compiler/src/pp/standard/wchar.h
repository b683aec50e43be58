#ifndef _WCHAR_H
#define _WCHAR_H
#include <stddef.h>
typedef int wint_t;
#define WEOF (-1)
#endif
