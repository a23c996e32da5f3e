//! The C side of a crate for firmware: functions that C calls, and the header that declares them.
//!
//! A kernel of any scene, with a name of its own. The C library `slipfit-capi` has slides alone,
//! and tables, monitor and prediction ahead of the clock.

use std::fmt::Write;

use crate::dynamics::driven::DriveKind;

/// What C sees of a kernel.
pub struct Border<'a> {
    /// The crate's name; functions and types begin with it.
    pub name: &'a str,
    /// The scene's title.
    pub title: &'a str,
    /// Step (s).
    pub step: f32,
    /// What flash tables are stamped with, if there is one drive.
    pub hash: Option<u64>,
    /// Bytes of an object, at least as many as it has.
    pub bytes: usize,
    /// The drives.
    pub drives: Vec<Driven<'a>>,
    /// How a unit and its state are made of the level `n`: an expression of Rust.
    pub start: &'a str,
}

/// A drive as C sees it.
pub struct Driven<'a> {
    /// Its function.
    pub function: String,
    /// What people call it.
    pub name: &'a str,
    /// What it gives.
    pub kind: DriveKind,
    /// Its effort and speed, from `parameters` and `state`: an expression of Rust.
    pub found: String,
}

/// What functions of C return, beside 0 for done: the pointer is null.
const NULL: i32 = 1;
/// A gap at level n is out of bounds, or n.
const OUT_OF_BOUNDS: i32 = 2;
/// The motion left the finite range and was held as it was.
const HELD: i32 = 3;

/// The bytes of an object of the mechanism that `source` describes, with at most so many `coordinates`: each number of the source may
/// be kept twice, each contact has some of its own and remembers some. The crate does not compile if they are too few.
pub fn bytes_of_mechanism(source: &str, coordinates: usize) -> usize {
    let count = |text: &str| source.matches(text).count();
    (8 * count("s(") + 64 * count("contact_") + 32 * coordinates + 128).next_multiple_of(8)
}

impl Border<'_> {
    /// Where functions and types of C begin.
    fn prefix(&self) -> String {
        self.name.replace('-', "_")
    }

    /// The module with the functions.
    pub fn rust(&self) -> String {
        let Self { start, bytes, .. } = self;
        let prefix = self.prefix();
        let mut text = format!(
            "//! What C calls, see `{prefix}.h`.\n\n\
             use core::mem::MaybeUninit;\n\n\
             use crate::*;\n\n\
             /// A unit and where it is.\n\
             pub struct Object {{\n    parameters: Parameters,\n    state: State,\n}}\n\n\
             /// What the header has room for.\n\
             const _: () = assert!(size_of::<Object>() <= {bytes} && align_of::<Object>() <= 8);\n\n\
             /// Force (N) or torque (N·m), and speed (m/s or rad/s), of a drive.\n\
             #[repr(C)]\n\
             pub struct Driven {{\n    pub effort: f32,\n    pub speed: f32,\n}}\n\n\
             #[unsafe(no_mangle)]\n\
             pub extern \"C\" fn {prefix}_init(unit: Option<&mut MaybeUninit<Object>>, n: f32) -> i32 {{\n    \
             let Some(unit) = unit else {{ return {NULL} }};\n    \
             let Ok((parameters, state)) = {start} else {{ return {OUT_OF_BOUNDS} }};\n    \
             unit.write(Object {{ parameters, state }});\n    0\n}}\n\n\
             #[unsafe(no_mangle)]\n\
             pub extern \"C\" fn {prefix}_step(unit: Option<&mut Object>) -> i32 {{\n    \
             let Some(Object {{ parameters, state }}) = unit else {{ return {NULL} }};\n    \
             if step(parameters, state).residual < f32::INFINITY {{ 0 }} else {{ {HELD} }}\n}}\n\n\
             #[unsafe(no_mangle)]\n\
             pub extern \"C\" fn {prefix}_time(unit: Option<&Object>) -> f32 {{\n    \
             unit.map_or(f32::NAN, |unit| unit.parameters.time(unit.state.steps))\n}}\n"
        );
        for Driven { function, found, .. } in &self.drives {
            let _ = write!(
                text,
                "\n#[unsafe(no_mangle)]\n\
                 pub extern \"C\" fn {prefix}_{function}(unit: Option<&Object>) -> Driven {{\n    \
                 let Some(Object {{ parameters, state }}) = unit else {{\n        \
                 return Driven {{ effort: f32::NAN, speed: f32::NAN }};\n    }};\n    \
                 {found}\n}}\n"
            );
        }
        let _ = write!(
            text,
            "\n/// A program links only while no panic is reachable: this calls what nobody defines.\n\
             #[cfg(all(feature = \"c\", target_os = \"none\"))]\n\
             #[panic_handler]\n\
             fn panic(_: &core::panic::PanicInfo<'_>) -> ! {{\n    \
             unsafe extern \"C\" {{\n        safe fn {prefix}_panic_is_reachable() -> !;\n    }}\n    \
             {prefix}_panic_is_reachable()\n}}\n"
        );
        text
    }

    /// The header.
    pub fn header(&self) -> String {
        let Self { name, bytes, step, .. } = self;
        let (prefix, upper) = (self.prefix(), self.prefix().to_uppercase());
        let title = self.title.replace("*/", "* /");
        let mut text = format!(
            "/* {title}: the kernel of a scene, written by slipfit. SI units.\n *\n \
             * In the crate's folder, for a Cortex-M4F:\n \
             *   cargo rustc --release --config profile.release.lto=true --features c --crate-type staticlib \\\n \
             *     --target thumbv7em-none-eabihf\n \
             * makes target/thumbv7em-none-eabihf/release/lib{prefix}.a. Link with -Wl,--gc-sections. Link-time optimisation\n \
             * drops the panic handler, so that it goes together with other libraries of Rust.\n \
             * Functions have no state of their own: calls for different units may interrupt each other. */\n\
             #ifndef {upper}_H\n#define {upper}_H\n\n#include <stdint.h>\n\n\
             #ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n\
             #define {upper}_STEP {step:?}f /* s */\n"
        );
        if let Some(hash) = self.hash {
            let _ =
                writeln!(text, "#define {upper}_SCENE_HASH {hash:#018x}ull /* what a flash table is stamped with */");
        }
        let _ = write!(
            text,
            "\n/* What functions return. */\n\
             enum {{\n    {upper}_OK = 0,\n    {upper}_NULL = {NULL},          /* the pointer is null */\n    \
             {upper}_OUT_OF_BOUNDS = {OUT_OF_BOUNDS}, /* a gap at level n is, or n */\n    \
             {upper}_HELD = {HELD}           /* the motion left the finite range and was held as it was */\n}};\n\n\
             /* A unit and where it is; {name} keeps its numbers in it. */\n\
             typedef struct {{\n    uint64_t words[{words}];\n}} {prefix};\n\n\
             /* What a drive gives and sees. */\n\
             typedef struct {{\n    float effort; /* N; N m of a drive that turns */\n    \
             float speed;  /* m/s; rad/s of a drive that turns */\n}} {prefix}_driven;\n\n\
             /* A unit of tolerance level n (positive is tighter) at the start of the scene's run. */\n\
             int32_t {prefix}_init({prefix} *unit, float n);\n\n\
             /* Moves it by {upper}_STEP: the same instructions whatever its state. */\n\
             int32_t {prefix}_step({prefix} *unit);\n\n\
             /* Its time (s). */\n\
             float {prefix}_time(const {prefix} *unit);\n",
            words = bytes / 8
        );
        for Driven { function, name, kind, .. } in &self.drives {
            let name = name.replace("*/", "* /");
            let (effort, speed) = (kind.choose("force (N)", "torque (N m)"), kind.choose("m/s", "rad/s"));
            let _ = write!(
                text,
                "\n/* {effort} and speed ({speed}) of the drive \"{name}\" now. */\n\
                 {prefix}_driven {prefix}_{function}(const {prefix} *unit);\n"
            );
        }
        text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
    }
}
