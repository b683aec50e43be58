//! The command as people, scripts and editors meet it: what it prints, what it writes and how it exits.

mod attach;
mod beside;
mod board_options;
mod boot;
mod boot_debug;
mod boot_mistakes;
mod console;
mod controller;
mod doctor;
mod drop_in;
mod editor;
mod explain;
mod golden;
mod init;
#[cfg(unix)]
mod interrupt;
mod jumps;
mod keyboard;
mod kogna;
#[cfg(feature = "live")]
mod live;
mod options;
mod plots;
mod profile;
mod races;
mod real_code;
mod run;
mod schedules;
mod serve;
mod shell;
mod simulated_kogna;
mod start;
mod targets;
mod traces;
mod trial;
