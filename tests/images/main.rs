//! Images: how they are built, written, read, shown, loaded and made stand-alone programs.

mod build;
mod formats;
mod inspect;
mod loader;
mod loading;
mod own_firmware;
#[cfg(feature = "native")]
mod stand_alone;
