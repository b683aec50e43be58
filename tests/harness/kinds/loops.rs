//! Loops over arrays, for software pipelining at -O2: filters, sums, copies, searches; also with few iterations.

use super::Writer;

/// The arrays, of 48 elements each.
const ARRAYS: &str = "static double $a[48], $b[48];\nstatic float $f[48], $g[48];\nstatic int $m[48], $n[48];\nstatic short $s[48], $t[48];\n\
                      static unsigned char $c[48];\n\n";

/// Fills the arrays from the arguments and from their values in the previous call.
const FILL: &str = "    for (i = 0; i < 48; i++) {
        $a[i] = i * 0.375 - 7 + (x & 15);
        $b[i] = $b[i] * 0.5 + i;
        $f[i] = i * 1.25f - (y & 7);
        $g[i] = 3 - i * 0.5f;
        $m[i] = i * 77 ^ x;
        $n[i] += $m[i] >> 3;
        $s[i] = i * 1001 - x;
        $t[i] = y >> (i & 15);
        $c[i] = i * 7 + y;
    }
";

/// Loops; `N` is a number of iterations, `K` a number, `R` a fraction less than a half.
const LOOPS: &[&str] = &[
    "p = q = 0;\n    for (i = 0; i < N; i++) {\n        double t = $a[i] - R * p + R * q;\n        q = p;\n        p = t;\n        $b[i] = t;\n    }",
    "for (i = 0; i < N; i++)\n        p += $a[i] * R;",
    "r = 0;\n    for (i = 0; i < N; i++)\n        r = r * Rf + $f[i] * $g[i];\n    p += r;",
    "for (i = 0; i + 1 < N; i += 2)\n        $b[i] = $a[i + 1] * R;",
    "for (i = 0; i < N; i++)\n        if ($f[i] > K)\n            $g[i] = K;\n        else\n            $g[i] = -$f[i];",
    "for (i = 0, k = 0; i < N; i++)\n        k += $s[i] * $t[i];\n    l += k;",
    "for (i = 1; i < N; i++)\n        $m[i] = $m[i - 1] + ($n[i] ^ K);",
    "for (i = N - 1; i > 0; i--)\n        $n[i] = $n[i - 1] + K;",
    "for (i = 0; i < N && $m[i] != K; i++)\n        l += i;",
    "for (i = 0; i < N; i++)\n        l += (long long)$m[i] * $n[i];",
    "for (i = 0; i < N; i++)\n        $c[i] ^= $c[47 - i];",
    "for (i = 0; i < N; i++)\n        $t[i] = ($s[i] * K) >> 4;",
    "for (i = 0; i < N / 4; i++)\n        for (k = 0; k < 4; k++)\n            $b[i * 4 + k] += $a[i * 4] * $b[k];",
    "k = N;\n    while (k-- > 0)\n        $m[k] = $m[k] * 3 - ($n[k] >> 2);",
    "for (i = 0; i < N; i++) {\n        int v = $m[i] < 0 ? -$m[i] : $m[i];\n        $n[i] = v > K ? v - K : v;\n    }",
    "{ int *d = $n, *e = $m + (K & 3);\n    for (i = 0; i < N - 4; i++)\n        *d++ = *e++ + K; }",
    "for (i = 0; i < N; i++)\n        $f[i] = $m[i] & 1023;",
    "for (i = 0; i < N; i++) {\n        sum = @mix(sum, $m[i]);\n        if (sum % 13 == 5)\n            break;\n    }",
    "for (i = 0; i < N; i++)\n        $a[i] = $a[i] > R ? $a[i] - R : $a[i] + $b[i];",
    "for (i = 0; i < N; i++) {\n        $m[i] += K;\n        $n[i] -= $m[i] & 255;\n        $s[i] = $n[i];\n    }",
];

/// Writes arrays and a function with a few loops over them.
pub(super) fn write(writer: &mut Writer) {
    writer.put(ARRAYS);
    writer.open("    double p = 0, q = 1;\n    float r = 0;\n    long long l = z;\n    int k = 0;\n");
    writer.put(FILL);
    for _ in 0..3 + writer.below(5) {
        let text = filled(writer);
        writer.line(&text);
    }
    writer.line("for (i = 0; i < 48; i++) {\n        sum = @real(@real(@real(@real(sum, $a[i]), $b[i]), $f[i]), $g[i]);");
    writer.line("    sum = @mix(@mix(@mix(@mix(@mix(sum, $m[i]), $n[i]), $s[i]), $t[i]), $c[i]);\n    }");
    writer.line("sum = @wide(@real(@real(sum, p), q), l) + k;");
    writer.close();
}

/// A loop with its placeholders filled in.
fn filled(writer: &mut Writer) -> String {
    let text = writer.pick(LOOPS);
    let count = match writer.below(5) {
        0 => "(x & 3)".to_owned(),
        1 => "(int)(y % 17)".to_owned(),
        2 => writer.below(9).to_string(),
        3 => "(x & 47)".to_owned(),
        _ => "48".to_owned(),
    };
    let (fraction, number) =
        (format!("0.{}", 1 + writer.below(49)), (writer.below(900) as i64 - 300).to_string());
    text.replace('N', &count).replace('K', &number).replace('R', &fraction)
}
