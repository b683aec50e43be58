//! The `cc67` command under a name with which tests of this package can start it.

fn main() -> std::process::ExitCode {
    cc67::cli::main(std::env::args_os())
}
