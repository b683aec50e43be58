//! The `cc67` command.

#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    cc67::cli::main(std::env::args_os())
}
