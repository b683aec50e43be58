// Points of the Mandelbrot set: doubles in registers, loops that end early.

int printf(const char *format, ...);

static int iterations(double x0, double y0)
{
    double x = 0, y = 0;
    int n;

    for (n = 0; n < 500; n++) {
        double xx = x * x, yy = y * y;

        if (xx + yy > 4.0)
            break;
        y = 2.0 * x * y + y0;
        x = xx - yy + x0;
    }
    return n;
}

int main(void)
{
    int row, column, sum = 0;

    for (row = 0; row < 1200; row++)
        for (column = 0; column < 1200; column++)
            sum += iterations(column / 400.0 - 2.25, row / 400.0 - 1.5);
    printf("%d iterations\n", sum);
    return 0;
}
