//! Operations for which the processor has no instruction, and operations that the vendor's compiler gets wrong.
//!
//! The program divides random doubles and floats, with the firmware's estimates off by up to three units in the last
//! place; the expected output was computed by another compiler.

use super::{build, machine};
use crate::passes::Level;

const SOURCE: &str = include_str!("language.c");

const PRINTED: &str = "\
072dbb8f
4 3 -2.500000
382
1 2 0 0
-1 5 7 11 13 17 19 -1 24
57d282b8
0 1
1 -3
3000000000 3000000000.000000
";

#[test]
fn division_64_bit_integers_structures_and_many_arguments_work() {
    for level in [Level::None, Level::Small, Level::Full, Level::Fast] {
        assert_eq!(machine::run(&build(SOURCE, level)).console, PRINTED, "{level:?}");
    }
}

/// Constants for a matrix are kept in registers across the calls of `sin` and `cos`.
const ROTATION: &str = r#"
#include "KMotionDef.h"
typedef struct { double x, y, z; } V3;
typedef struct { V3 r[3]; } M3;
M3 about_z(double t) { M3 m = { { { cos(t), -sin(t), 0 }, { sin(t), cos(t) }, { 0, 0, 1 } } }; return m; }
double (*function)(double) = sin;
double through_pointer(double t, double *p) { double s = function(t); p[0] = 0; p[1] = 0.5; p[2] = 0; return s; }
main()
{
    double p[3];
    M3 m = about_z(0);
    printf("%g %g %g\n", m.r[0].x, m.r[0].y, m.r[2].z);
    printf("%g\n", through_pointer(0, p));
}
"#;

#[test]
fn a_caller_waits_for_results_still_in_flight_after_a_return() {
    for level in [Level::None, Level::Small, Level::Full, Level::Fast] {
        assert_eq!(machine::run(&build(ROTATION, level)).console, "1 -0 1\n0\n", "{level:?}");
    }
}

/// All argument registers are pairs, from memory: they fit only on their own sides.
const ARGUMENTS: &str = r#"
#include "KMotionDef.h"
typedef struct { int x; double y; char n[5]; } REC;
REC swap(REC a, REC b, int which, double add, REC *last) { REC r = which ? a : b; r.y += add; *last = a; return r; }
long long mix(long long a, long long b, long long c, double d, long long e, short f, long long g, long long h, int i,
    long long j, long long k) { return a + b - c + (int)d - e + f - g + h - i + j - k; }
main()
{
    int i;
    REC a = { 1, 1.5 }, b = { 2, 2.5 }, c, d;
    long long r = mix(10, -7, 1LL << 32, 12, -5, 300, 1LL << 40, -123, 77, 987, -1000);
    printf("%d %d\n", (int)(r >> 32), (int)r);
    for (i = 0; i < 2; i++) {
        c = swap(a, b, i, 0.125, &d);
        printf("%d %d\n", c.x, d.x);
    }
    printf("%d %g\n", swap(swap(a, b, 1, 10, &d), swap(b, a, 1, 20, &c), 0, 30, &d).x,
        swap(swap(a, b, 1, 10, &d), swap(b, a, 1, 20, &c), 0, 30, &d).y);
}
"#;

#[test]
fn ten_64_bit_arguments_fit_into_their_registers() {
    for level in [Level::None, Level::Small, Level::Full, Level::Fast] {
        let printed = "-257 2107\n2 1\n1 1\n2 52.5\n";
        assert_eq!(machine::run(&build(ARGUMENTS, level)).console, printed, "{level:?}");
    }
}

/// Loops with an unknown number of iterations: unrolled loops must end where each iteration would.
const LOOPS: &str = r#"
#include "KMotionDef.h"
char text[] = "several turns";
int a[9] = { 3, -1, 4, 1, -5, 9, 2, 6, 5 };
double d[5] = { 1.5, 2.25, -3.0, 4.0, 0.5 };
int length(char *p) { int n = 0; while (*p++) n++; return n; }
int sum(int *p, int n) { int i, s = 0; for (i = 0; i < n; i++) s += p[i]; return s; }
int most(int *p, int n) { int i, m = p[0]; for (i = 1; i < n; i++) if (p[i] > m) m = p[i]; return m; }
double product(double *p, int n) { double r = 1; int i; for (i = 0; i < n; i++) r *= p[i]; return r; }
long long wide(int n) { long long s = 1; while (n-- > 0) s = s * 3 + n; return s; }
void copy(int *to, int *from, int n) { do { *to++ = *from++; } while (--n != 0); }
int steps(int n) { int k = 0; while (n != 1) { if (n & 1) n = 3 * n + 1; else n = n >> 1; k++; } return k; }
void bump(int *p, int n) { int i; for (i = 0; i < n; i++) if (p[i] < 0) p[i] = p[i] + 100; }
main()
{
    int n, b[10];
    for (n = 0; n < 10; n++) b[n] = 77;
    for (n = 0; n < 14; n++) printf("%d ", length(text + n - (n > 13)));
    for (n = 0; n < 10; n++) printf("%d ", sum(a, n));
    for (n = 1; n < 10; n++) printf("%d ", most(a, n));
    printf("
");
    for (n = 0; n < 6; n++) printf("%.4f ", product(d, n));
    for (n = 0; n < 7; n++) printf("%d ", (int)wide(n));
    for (n = 1; n < 9; n++) { copy(b, a, n); printf("%d%d ", b[n - 1], b[n]); }
    for (n = 1; n < 12; n++) printf("%d ", steps(n));
    bump(b, 7);
    for (n = 0; n < 10; n++) printf("%d ", b[n]);
    printf("
");
}
"#;

#[test]
fn unrolled_loops_end_at_the_same_iteration() {
    let [plain, full, fast] =
        [Level::None, Level::Full, Level::Fast].map(|level| machine::run(&build(LOOPS, level)));
    assert_eq!(plain.console.lines().count(), 2, "{}", plain.console);
    assert!(plain.console.starts_with("13 12 11 10 9 8 7 6 5 4 3 2 1 0 0 3 2 6 7 2 11 13 19 24 3 3 4 4 4 9"));
    assert_eq!(plain.console, full.console);
    assert_eq!(plain.console, fast.console);
}
