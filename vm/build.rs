//! Determines whether handlers of the interpreter may continue by calling each other: see `src/interp/dispatch.rs`.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(tail_calls)");
    let setting = |name: &str| std::env::var(name).unwrap_or_default();
    // In a profile that inherits from `dev`, the compiler does not turn all of these calls into jumps, at any
    // optimisation level, and a long program would overflow the host's stack.
    let is_optimised = setting("PROFILE") == "release" && matches!(setting("OPT_LEVEL").as_str(), "2" | "3");
    let has_registers = matches!(setting("CARGO_CFG_TARGET_ARCH").as_str(), "x86_64" | "aarch64");
    // The calling convention of Windows passes one argument fewer in registers than a handler needs.
    if is_optimised && has_registers && setting("CARGO_CFG_TARGET_OS") != "windows" {
        println!("cargo::rustc-cfg=tail_calls");
    }
}
