//! Links the command for a fast start.

/// On Linux the executable gets a fixed address.
///
/// One that can be loaded anywhere has 25,000 pointers to adjust and 130 pages to copy before `main`, a fifth of the
/// time in which a program of 300 lines is compiled. Libraries, heap, stacks and the machine code of programs keep
/// their random addresses; what a program can reach does not depend on any address, each of its accesses is checked.
fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = |what: &str| std::env::var(format!("CARGO_CFG_TARGET_{what}")).unwrap_or_default();
    let is_static = target("FEATURE").split(',').any(|feature| feature == "crt-static");
    if target("OS") == "linux" && target("ENV") == "gnu" && !is_static {
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}
