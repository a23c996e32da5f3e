//! Links an image: cortex-m-rt's script, with the memory map of the emulated chip, which is at the root of the repository.

use std::{env, path::Path};

fn main() {
    let package = env::var("CARGO_MANIFEST_DIR").expect("Cargo says where the package is");
    let root = Path::new(&package).join("../../..");
    println!("cargo::rerun-if-changed={}", root.join("memory.x").display());
    println!("cargo::rustc-link-search={}", root.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
}
