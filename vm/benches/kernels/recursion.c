// Calls: Fibonacci and Ackermann, as a compiler that does not inline sees them.

int printf(const char *format, ...);

static int fibonacci(int n)
{
    return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2);
}

static int ackermann(int m, int n)
{
    if (m == 0)
        return n + 1;
    if (n == 0)
        return ackermann(m - 1, 1);
    return ackermann(m - 1, ackermann(m, n - 1));
}

int main(void)
{
    int round, sum = 0;

    for (round = 0; round < 400; round++)
        sum += ackermann(2, 25 + round % 5);
    printf("%d %d\n", fibonacci(41), sum);
    return 0;
}
