//! The image: everything that must not panic, and a panic handler that does not link.

use core::{hint::black_box, panic::PanicInfo};

#[allow(unsafe_code, reason = "a symbol that nobody defines can only be declared as foreign")]
unsafe extern "C" {
    safe fn panic_is_reachable() -> !;
}

#[cortex_m_rt::entry]
fn main() -> ! {
    crate::uses::all();
    if cfg!(feature = "reachable-panic") {
        assert!(black_box(true));
    }
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    panic_is_reachable()
}
