//! Releases: packages, third-party notices, workflows, the extension for VS Code, promises of the pages.

mod extension;
mod notices;
mod packages;
mod promises;
mod workflows;

use harness::{files, relative, root};
