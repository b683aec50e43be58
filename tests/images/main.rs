//! Images: building, writing, reading, showing and loading them.

mod build;
mod formats;
mod inspect;
mod kogna;
mod loader;
mod loading;
mod own_firmware;
