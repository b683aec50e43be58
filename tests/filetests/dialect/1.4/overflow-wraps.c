//@ prints: -2147483648 2147483647 -727379968 -2147483648
//@ prints: -2147483648 2147483647 -727379968 -2147483648
//@ prints: 1
#include "KMotionDef.h"

int most = 2147483647, least = (int)0x80000000, million = 1000000, one = 1;
static int sum = 2147483647 + 1, difference = (int)0x80000000 - 1, product = 1000000 * 1000000;
//~^ overflow: 2147483648
//~^^ overflow: -2147483649
//~^^^ overflow: 1000000000000
static int negated = -(int)0x80000000;
enum { SUM = 2147483647 + 1, PRODUCT = 1000000 * 1000000 };
//~^ overflow: 2147483648
//~^^ overflow: 1000000000000

main()
{
    printf("%d %d %d %d\n", most + one, least - one, million * million, -least); //~ overflow
    printf("%d %d %d %d\n", sum, difference, product, negated);
    switch (most + one) {
    case 2147483647 + 1: printf("%d\n", SUM == sum && PRODUCT == product); //~ overflow
    }
}
//@ cycles: 40367
