// Functions that the vendor's compiler calls for divisions, called by name; and an end in the middle.
//@ prints: -3 571428571 -1 3
//@ prints: 0.25 0.333333
int printf(const char *format, ...);
void abort(void);
int _divi(int a, int b), _remi(int a, int b);
unsigned _divu(unsigned a, unsigned b), _remu(unsigned a, unsigned b);
float _divf(float a, float b);
double _divd(double a, double b);

main()
{
    printf("%d %u %d %u\n", _divi(-7, 2), _divu(4000000000u, 7), _remi(-7, 2), _remu(4000000000u, 7));
    printf("%g %g\n", _divf(1, 4), _divd(1, 3));
    abort();
    printf("not here\n");
}
//@ cycles: 20045
