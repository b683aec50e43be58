//! A page that is left open: the frames that it paints, what server and board take of a processor, what both hold.
//!
//! `cargo test` looks for some seconds, beside everything else that the computer does. With `CC67_LONG=1` in the
//! environment it is an hour with the limits that hold for a computer with two cores:
//! `CC67_LONG=1 cargo test --release -p cc67-tests --test command live::lasting -- --nocapture`.

use std::fs;
use std::thread::sleep;
use std::time::{Duration, Instant};

use harness::usage::Usage;
use harness::{Scratch, is_long};

use super::Live;
use super::browser::Browser;
use super::page::{axis, shows};

/// Eight axes that never rest, a bit that changes all the time, and somebody who says so.
const PROGRAM: &str = "\
#include \"KMotionDef.h\"
main()
{
    int i, k = 0;
    for (i = 0; i < 8; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = i;
        chan[i].Vel = 4000 + 500 * i;
        chan[i].Accel = 20000;
        chan[i].Jerk = 200000;
        EnableAxisDest(i, 0);
    }
    for (;;)
    {
        for (i = 0; i < 8; i++)
            if (CheckDone(i)) Move(i, chan[i].Dest > 0 ? -1000.0 - 100 * i : 1000.0 + 100 * i);
        if (++k % 1000 == 1) printf(\"%d\\n\", k);
        SetStateBit(46, k & 1);
        WaitNextTimeSlice();
    }
}
";

/// The signals of the scope.
const SIGNALS: &str = "dest0,dest1,dest2,dest3,dest4,dest5,dest6,dest7,bit46,bit136,out0,out1";

/// Counts call-backs of the browser's pictures in which the scope is drawn.
const COUNTER: &str = "\
window.painted = 0;
const next = window.requestAnimationFrame.bind(window);
const { prototype } = CanvasRenderingContext2D;
const clear = prototype.clearRect;
let present = 0, last = -1;
window.requestAnimationFrame = (draw) => next((time) => { present = time; draw(time); });
prototype.clearRect = function (...box) {
  if (this.canvas.closest('#scope') && present !== last) { last = present; window.painted += 1; }
  return clear.apply(this, box);
};
";

/// The extent of a trial, and its limits.
struct Trial {
    readings: usize,
    every: Duration,
    /// Pictures a second, over all.
    frames: f64,
    /// The allowed growth of server and page from half-way to the end, in MiB.
    growth: f64,
}

/// Beside other tests and builds there is no pace to rely on.
const MOMENT: Trial = Trial { readings: 4, every: Duration::from_secs(1), frames: 0.2, growth: 24.0 };
/// The page asks for 30 frames a second.
const HOUR: Trial = Trial { readings: 60, every: Duration::from_secs(60), frames: 29.5, growth: 4.0 };
/// The part of a core that server and board may take at the pace of the real board.
const CORE: f64 = 0.6;

/// The measurements at a moment.
struct Reading {
    at: Instant,
    painted: f64,
    server: Usage,
    /// The heap of the page after garbage collection, in MiB; 0 of a browser that does not tell.
    heap: f64,
}

impl Reading {
    #[expect(clippy::disallowed_methods, reason = "frames are counted by the clock of the wall")]
    fn take(browser: &mut Browser, live: &Live) -> Self {
        let painted = browser.value("painted").as_f64().expect("a number");
        let (at, server) = (Instant::now(), Usage::of(live.child.id()));
        let heap = browser.heap().unwrap_or_default() / f64::from(1 << 20);
        Self { at, painted, server, heap }
    }

    /// Returns the memory of the server, in MiB.
    fn memory(&self) -> f64 {
        self.server.memory as f64 / 1024.0
    }

    /// Pictures a second and the part of a core between an earlier moment and this one.
    fn since(&self, earlier: &Self) -> (f64, f64) {
        let seconds = (self.at - earlier.at).as_secs_f64();
        let cpu = (self.server.cpu - earlier.server.cpu).as_secs_f64();
        ((self.painted - earlier.painted) / seconds, cpu / seconds)
    }
}

#[test]
fn a_page_left_open_does_not_paint_or_hold_more_over_time() {
    let Some(mut browser) = Browser::start() else { return };
    let trial = if is_long() { HOUR } else { MOMENT };
    let folder = Scratch::new("live-lasting");
    fs::write(folder.path().join("eight.c"), PROGRAM).expect("files can be written");
    let live = Live::start(&folder, &["eight.c", "--watch", SIGNALS]);
    browser.preload(&format!("{{ {COUNTER} }}"));
    browser.open(&live.url);
    browser.until(&shows("#console", "1"));
    browser.until(&format!("{} !== 0 && painted > 0", axis("Dest")));

    let mut readings = vec![Reading::take(&mut browser, &live)];
    println!("reading  frames a second  of a core  server, MiB  page, MiB");
    for number in 1..=trial.readings {
        sleep(trial.every);
        let (before, next) = (readings.last().expect("the first"), Reading::take(&mut browser, &live));
        let (frames, core) = next.since(before);
        let held = format!("{:>11.1}  {:>9.2}", next.memory(), next.heap);
        println!("{number:>7}  {frames:>15.2}  {:>8.1} %  {held}", core * 100.0);
        readings.push(next);
    }
    check(&trial, &readings);
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}

fn check(trial: &Trial, readings: &[Reading]) {
    let (Some(first), Some(last)) = (readings.first(), readings.last()) else { panic!("there are readings") };
    let half = &readings[readings.len() / 2];
    let (frames, core) = last.since(first);
    assert!(frames >= trial.frames, "{frames} frames a second, of {}", trial.frames);
    assert!(core < CORE, "server and board take {core} of a core");
    let (server, page) = (last.memory() - half.memory(), last.heap - half.heap);
    assert!(server < trial.growth, "the server holds {server} MiB more than half-way");
    assert!(page < trial.growth, "the page holds {page} MiB more than half-way");
}
