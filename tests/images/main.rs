//! Images: how they are built, written, read, shown, and loaded.

mod build;
mod formats;
mod inspect;
mod kogna;
mod loader;
mod loading;
mod own_firmware;
