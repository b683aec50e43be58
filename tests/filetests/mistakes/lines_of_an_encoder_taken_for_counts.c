//@ args: --machine parts/encoder_of_1000_lines.toml
//@ says: thread 1 at lines_of_an_encoder_taken_for_counts.c:7:5 in `main`: ConfigureSpindle: 1000 counts per revolution, but the encoder of the spindle has 4000 (four for each line), so speeds and threads are wrong by that factor
#include "KMotionDef.h"

main()
{
    ConfigureSpindle(1, 3, 0.1, 0.1, 1000);
}
