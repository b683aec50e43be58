//! The command as people, scripts and editors meet it: what it prints, what it writes and how it exits.

mod console;
mod drop_in;
mod golden;
mod init;
mod keyboard;
mod plots;
mod profile;
mod run;
mod serve;
mod shell;
mod traces;
