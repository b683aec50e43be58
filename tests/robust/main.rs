//! What must hold whatever happens: any bytes, any length, a full disk, a program that means harm.

mod failures;
mod hostile_sources;
mod inputs;
mod levels;
mod limits;
mod long;
mod oracles;
mod security;
