//@ byte: ␌ 0c
//@ byte: ␋ 0b
//@ byte: ␉ 09
//@ prints: 7
␌
#include␉"KMotionDef.h"
␋
#define␉SEVEN␋7␉

␉main()␌
{
␉␋printf("%d\n",␉SEVEN␌);
}
␌
//@ cycles: 2481
