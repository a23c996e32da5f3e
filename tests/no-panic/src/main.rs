//! Links for a Cortex-M, in release, only while no panic is reachable from making and stepping any kernel of the menu and
//! from opening a flash table and looking it up: the panic handler calls what nobody defines.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod uses;

#[cfg(target_os = "none")]
mod image;

#[cfg(not(target_os = "none"))]
fn main() {
    uses::all();
}
