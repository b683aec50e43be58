// Integer arithmetic: the longest Collatz sequence, and a hash of what was seen on the way.

int printf(const char *format, ...);

static unsigned hash;

static int length(unsigned n)
{
    int steps = 1;

    while (n != 1) {
        n = n & 1 ? 3 * n + 1 : n >> 1;
        steps++;
    }
    return steps;
}

int main(void)
{
    unsigned n, best = 0;
    int longest = 0;

    for (n = 1; n < 1500000; n++) {
        int steps = length(n);

        hash = (hash ^ steps) * 16777619u + n % 7 - n / 13;
        if (steps > longest) {
            longest = steps;
            best = n;
        }
    }
    printf("%u takes %d steps, hash %08x\n", best, longest, hash);
    return 0;
}
