// Products of matrices of doubles.

int printf(const char *format, ...);

#define N 120

static double a[N][N], b[N][N], c[N][N];

static void multiply(void)
{
    int i, j, k;

    for (i = 0; i < N; i++)
        for (j = 0; j < N; j++) {
            double sum = 0;

            for (k = 0; k < N; k++)
                sum += a[i][k] * b[k][j];
            c[i][j] = sum;
        }
}

int main(void)
{
    int i, j, round;
    double trace = 0;

    for (i = 0; i < N; i++)
        for (j = 0; j < N; j++) {
            a[i][j] = (i + 2 * j) % 7 / 8.0;
            b[i][j] = (3 * i - j) % 5 / 16.0;
        }
    for (round = 0; round < 400; round++) {
        multiply();
        for (i = 0; i < N; i++)
            for (j = 0; j < N; j++)
                a[i][j] = 0.9 * a[i][j] + c[i][j] / 64.0 + i / 1024.0;
    }
    for (i = 0; i < N; i++)
        trace += c[i][i];
    printf("trace %.12f\n", trace);
    return 0;
}
