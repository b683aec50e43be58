// The sieve of Eratosthenes, again and again over an array of bytes.

int printf(const char *format, ...);

static char composite[300000];

static int sieve(int limit)
{
    int i, j, count = 0;

    for (i = 0; i < limit; i++)
        composite[i] = 0;
    for (i = 2; i < limit; i++) {
        if (composite[i])
            continue;
        count++;
        for (j = 2 * i; j < limit; j += i)
            composite[j] = 1;
    }
    return count;
}

int main(void)
{
    int round, count = 0;

    for (round = 0; round < 800; round++)
        count += sieve(300000 - round);
    printf("%d primes\n", count);
    return 0;
}
