//! Links an image by the start-up crate's script, with the memory map of the board that its core is emulated on.

use std::{env, fs, path::Path};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = env::var("TARGET").expect("Cargo says what for");
    let [flash, ram] = match target.split('-').next() {
        // mps2-an505, in its secure memory.
        Some("thumbv8m.main") => [0x1000_0000, 0x3800_0000],
        // virt, which has RAM only.
        Some("riscv32imafc") => [0x8000_0000_u32, 0x8004_0000],
        // microbit and the other boards mps2.
        _ => [0, 0x2000_0000],
    };
    // As much as the smallest has, and no flash table; below, where riscv-rt is told to put what.
    let mut map = format!(
        "MEMORY\n{{\n  FLASH : ORIGIN = {flash:#x}, LENGTH = 256K\n  RAM : ORIGIN = {ram:#x}, LENGTH = 16K\n}}\n\
         _table_start = ORIGIN(FLASH);\n_table_end = ORIGIN(FLASH);\n"
    );
    if target.starts_with("riscv") {
        for (name, region) in
            [("TEXT", "FLASH"), ("RODATA", "FLASH"), ("DATA", "RAM"), ("BSS", "RAM"), ("HEAP", "RAM"), ("STACK", "RAM")]
        {
            map += &format!("REGION_ALIAS(\"REGION_{name}\", {region});\n");
        }
    }
    let folder = env::var("OUT_DIR").expect("Cargo says where to");
    fs::write(Path::new(&folder).join("memory.x"), map).expect("Cargo's folder takes files");
    println!("cargo::rustc-link-search={folder}");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
}
