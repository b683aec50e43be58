//! A program truncated at each of its tokens, and one without each of them.

use super::Input;

/// A program with many features.
const PROGRAM: &str = r#"#include "KMotionDef.h"
#define SCALE(x, y) ((x) * (y))
#if defined(SCALE) && SCALE(2, 3) == 6
typedef struct point { double x, y; struct point *next; } POINT;
#else
#error no scale
#endif
enum state { IDLE, RUN = 5, STOP };
static int table[2][3] = { { 1, 2, 3 }, [1] = { 'a', 0x1F, 010 } };
double scale(float f, ...);
int count = 5, *where = &count;
double scale(float f, ...)
{
    POINT here = { .x = 1.5f, .y = 2e3 };
    return f ? here.x * f : -here.y;
}
main()
{
    int i, state = IDLE;
    for (i = 0; i < 3; i++)
    {
        if (table[1][i] >= 'b' || !ReadBit(46)) continue;
        else count += SCALE(i, *where) << 2;
        switch (state)
        {
            case IDLE: state = RUN; break;
            case RUN ... 9: goto done;
            default: do state--; while (state > 0);
        }
    }
done:
    ch0->Vel = (float)scale(2.0f, "text", sizeof(POINT));
    printf("%d %s\n", (int)ch0->Vel, "end");
}
"#;

/// Returns the approximate ends of the program's tokens: between words, and around each sign.
fn ends() -> Vec<usize> {
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let bytes = PROGRAM.as_bytes();
    (1..bytes.len())
        .filter(|at| {
            let (before, behind) = (bytes[at - 1], bytes[*at]);
            !(before.is_ascii_whitespace() || is_word(before) && is_word(behind))
        })
        .collect()
}

/// The program truncated at each token, and without each token.
pub(super) fn inputs() -> Vec<Input> {
    let ends = ends();
    let cut = ends.iter().map(|end| Input::new(format!("a program of {end} bytes"), &PROGRAM[..*end]));
    let without = ends.windows(2).map(|pair| {
        let text = format!("{}{}", &PROGRAM[..pair[0]], &PROGRAM[pair[1]..]);
        Input::new(format!("a program without bytes {} to {}", pair[0], pair[1]), text)
    });
    cut.chain(without).collect()
}
