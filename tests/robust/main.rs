//! Properties that must hold for any bytes, any length, a full disk, and a malicious program.

mod failures;
mod hostile_sources;
mod inputs;
mod levels;
mod limits;
mod long;
mod oracles;
mod security;
