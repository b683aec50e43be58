//! The `cc67` command under a name that tests of this package can start.

fn main() -> std::process::ExitCode {
    cc67::cli::main(std::env::args_os())
}
