// Conditions in conditions, in every sense: what `!`, `&&` and `||` of each other lead to, and what they cost on the way,
// is beside the same in arithmetic.
//@ prints: 0 differences
#include "KMotionDef.h"

int a, b, c, d, wrong;

#define N(x) (1 - (x))
#define A(x, y) ((x) * (y))
#define O(x, y) N(A(N(x), N(y)))

/* Each condition as those of if, of ?:, of while, of for, of do, and as an operand. */
#define TRY(condition, value)                                     \
    {                                                             \
        int expected = (value), n = 0;                            \
        if (condition) n |= 1;                                    \
        n |= (condition) ? 2 : 0;                                 \
        while (condition) { n |= 4; break; }                      \
        for (; condition;) { n |= 8; break; }                     \
        do if (n & 16) { n |= 32; break; } else n |= 16; while (condition); \
        n |= (condition) << 6;                                    \
        if ((condition) && d) n |= 128;                           \
        if (d - 1 || (condition)) n |= 256;                       \
        if (!(condition)) n |= 512;                               \
        if (n != (expected ? 16 + 1 + 2 + 4 + 8 + 32 + 64 + 128 + 256 : 16 + 512)) wrong++; \
    }

main()
{
    int i;
    d = 1;
    for (i = 0; i < 8; i++)
    {
        a = i & 1, b = (i >> 1) & 1, c = i >> 2;
        TRY(a && b, A(a, b))
        TRY(a || b, O(a, b))
        TRY(!(a && b), N(A(a, b)))
        TRY(!(a || b), N(O(a, b)))
        TRY(!a && !b, A(N(a), N(b)))
        TRY((a && b) || c, O(A(a, b), c))
        TRY((a || b) && c, A(O(a, b), c))
        TRY(a || (b && c), O(a, A(b, c)))
        TRY(a && (b || c), A(a, O(b, c)))
        TRY(!((a && b) || c), N(O(A(a, b), c)))
        TRY(!((a || b) && c), N(A(O(a, b), c)))
        TRY(!(a || (b && c)), N(O(a, A(b, c))))
        TRY(!(a && (b || c)), N(A(a, O(b, c))))
        TRY(!(!(a && b) || c), N(O(N(A(a, b)), c)))
        TRY(!(!(a || b) && c), N(A(N(O(a, b)), c)))
        TRY(!(a && !(b && c)), N(A(a, N(A(b, c)))))
        TRY(!(a || !(b || c)), N(O(a, N(O(b, c)))))
        TRY(!(a && (b || (c && a))), N(A(a, O(b, A(c, a)))))
        TRY(!(a || (b && (c || a))), N(O(a, A(b, O(c, a)))))
        TRY(!!((a && b) || !(b && c)), O(A(a, b), N(A(b, c))))
        TRY(!((a && b) || (b && c) || !(c && a)), N(O(O(A(a, b), A(b, c)), N(A(c, a)))))
        TRY(!((a || b) && (b || c) && !(c || a)), N(A(A(O(a, b), O(b, c)), N(O(c, a)))))
        TRY((a == 0) != (b && c), O(A(N(a), N(A(b, c))), A(a, A(b, c))))
        TRY(!(!((a && b) || c) && (b || !(a && c))), N(A(N(O(A(a, b), c)), O(b, N(A(a, c))))))
    }
    printf("%d differences\n", wrong);
}
