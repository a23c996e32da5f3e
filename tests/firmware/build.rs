//! Links an image for a bare target: cortex-m-rt's script with the memory map at the root of the repository.
//!
//! Here and not in Cargo's configuration, because RUSTFLAGS in the environment replaces the flags there.

use std::{env, path::Path};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // The board of a core goes by its architecture, whose clock the board's counts need.
    println!("cargo::rustc-check-cfg=cfg(armv6m, armv8m)");
    let target = env::var("TARGET").expect("Cargo says what for");
    for (start, name) in [("thumbv6m", "armv6m"), ("thumbv8m", "armv8m")] {
        if target.starts_with(start) {
            println!("cargo::rustc-cfg={name}");
        }
    }
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let package = env::var("CARGO_MANIFEST_DIR").expect("Cargo says where the package is");
    let root = Path::new(&package).join("../..");
    println!("cargo::rerun-if-changed={}", root.join("memory.x").display());
    println!("cargo::rustc-link-search={}", root.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    if env::var_os("CARGO_FEATURE_DEFMT").is_some() {
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    }
}
