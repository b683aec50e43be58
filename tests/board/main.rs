//! The simulated board: its threads, devices, files and script commands, used by programs and by the PC.

mod c_interface;
mod cost;
mod cost_calls;
mod cost_firmware;
mod cost_statements;
mod cost_threads;
mod devices;
mod disk_files;
mod fidelity;
mod firmware_5;
mod host;
mod injection;
mod mathematics;
mod measured;
mod polling;
mod released;
mod session;
mod snapshots;
mod surroundings;
mod targets;
mod threads;
mod transcripts;
mod witness;
mod world;
