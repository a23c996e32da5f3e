//! The C side of a crate for firmware: functions that C calls, and the header that declares them.
//!
//! A kernel of any scene, with a name of its own. The C library `slipfit-capi` has slides alone,
//! and tables, monitor and prediction ahead of the clock.

use std::fmt::Write;

use super::guard::guarded;
use crate::dynamics::driven::DriveKind;

/// What C sees of a kernel.
pub struct Border<'a> {
    /// The crate's name; functions and types begin with it, and none of them is the name alone, which may be a keyword of C.
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
    /// The state of a unit's `parameters` at the start: an expression of Rust.
    pub at_start: &'a str,
}

/// A drive as C sees it.
pub struct Driven<'a> {
    /// Its function.
    pub function: String,
    /// The function that sets its command.
    pub command: String,
    /// What people call it.
    pub name: &'a str,
    /// What it gives.
    pub kind: DriveKind,
    /// Its effort and speed, from `parameters` and `state`: an expression of Rust.
    pub found: String,
    /// A statement of Rust that sets the commanded `speed` in `parameters`.
    pub set_command: String,
}

/// What functions of C return, beside 0 for done: the pointer is null.
const NULL: i32 = 1;
/// A gap at level n is out of bounds, or n, or a commanded speed.
const OUT_OF_BOUNDS: i32 = 2;
/// The motion left the finite range and was held as it was.
const HELD: i32 = 3;
/// The pointer is not aligned to eight bytes.
const MISALIGNED: i32 = 4;
/// The unit was not made, or making it failed.
const NOT_MADE: i32 = 5;

/// What the memory of a unit that was made starts with.
const MARK: u64 = 0x534c_4b31_a5c3_96e1;

/// The bytes of an object of the mechanism that `source` describes, with at most so many `coordinates`: each number of the source may
/// be kept twice, each contact has some of its own and remembers some. The crate does not compile if they are too few.
pub fn bytes_of_mechanism(source: &str, coordinates: usize) -> usize {
    let count = |text: &str| source.matches(text).count();
    (8 * count("s(") + 64 * count("contact_") + 32 * coordinates + 128 + size_of_val(&MARK)).next_multiple_of(8)
}

impl Border<'_> {
    /// Where functions and types of C begin.
    fn prefix(&self) -> String {
        self.name.replace('-', "_")
    }

    /// The module with the functions.
    pub fn rust(&self) -> String {
        let Self { start, at_start, bytes, .. } = self;
        let prefix = self.prefix();
        let mut text = format!(
            "//! What C calls, see `{prefix}.h`. Written by slipfit.\n\n\
             use core::mem::MaybeUninit;\n\n\
             use crate::*;\n\n\
             /// What the memory of a unit that was made starts with.\n\
             const MARK: u64 = {MARK:#x};\n\n\
             /// A unit and where it is.\n\
             struct Object {{\n    parameters: Parameters,\n    state: State,\n}}\n\n\
             /// The memory of a unit.\n\
             #[repr(C)]\n\
             pub struct Memory {{\n    mark: u64,\n    object: MaybeUninit<Object>,\n}}\n\n\
             /// What the header has room for.\n\
             const _: () = assert!(size_of::<Memory>() <= {bytes} && align_of::<Memory>() == 8);\n\n\
             /// Force (N) or torque (N·m), and speed (m/s or rad/s), of a drive.\n\
             #[repr(C)]\n\
             pub struct Driven {{\n    pub effort: f32,\n    pub speed: f32,\n}}\n\n\
             fn checked(unit: *const Memory) -> Result<(), i32> {{\n    \
             if unit.is_null() {{\n        Err({NULL})\n    }} else if unit.is_aligned() {{\n        Ok(())\n    }} else {{\n        \
             Err({MISALIGNED})\n    }}\n}}\n\n\
             /// The unit in its memory.\n///\n/// # Safety\n\
             /// If the pointer is neither null nor misaligned, the memory is there, has been written, and nobody writes it meanwhile.\n\
             unsafe fn made<'a>(unit: *const Memory) -> Result<&'a Object, i32> {{\n    \
             checked(unit)?;\n    \
             // SAFETY: checked, and the caller's promise; the mark says that the unit was made.\n    \
             unsafe {{\n        if (&raw const (*unit).mark).read() != MARK {{\n            return Err({NOT_MADE});\n        }}\n        \
             Ok((*unit).object.assume_init_ref())\n    }}\n}}\n\n\
             /// # Safety\n/// As the header says.\n\
             #[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {prefix}_init(unit: *mut Memory, n: f32) -> i32 {{\n    \
             if let Err(why) = checked(unit) {{\n        return why;\n    }}\n    \
             // Until that succeeds there is none, whatever was there before.\n    \
             // SAFETY: checked, and the caller's promise.\n    \
             unsafe {{ (&raw mut (*unit).mark).write(0) }};\n    \
             let Ok((parameters, state)) = {start} else {{ return {OUT_OF_BOUNDS} }};\n    \
             // SAFETY: as above.\n    \
             unsafe {{\n        (&raw mut (*unit).object).write(MaybeUninit::new(Object {{ parameters, state }}));\n        \
             (&raw mut (*unit).mark).write(MARK);\n    }}\n    0\n}}\n\n\
             /// # Safety\n/// As the header says.\n\
             #[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {prefix}_step(unit: *mut Memory) -> i32 {{\n    \
             // SAFETY: the caller's promise.\n    \
             if let Err(why) = unsafe {{ made(unit) }} {{\n        return why;\n    }}\n    \
             // SAFETY: it was made, and the caller's promise that nobody else uses it meanwhile.\n    \
             let Object {{ parameters, state }} = unsafe {{ (*unit).object.assume_init_mut() }};\n    \
             if step(parameters, state).residual < f32::INFINITY {{ 0 }} else {{ {HELD} }}\n}}\n\n\
             /// # Safety\n/// As the header says.\n\
             #[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {prefix}_restart(unit: *mut Memory) -> i32 {{\n    \
             // SAFETY: the caller's promise.\n    \
             if let Err(why) = unsafe {{ made(unit) }} {{\n        return why;\n    }}\n    \
             // SAFETY: it was made, and the caller's promise that nobody else uses it meanwhile.\n    \
             let Object {{ parameters, state }} = unsafe {{ (*unit).object.assume_init_mut() }};\n    \
             *state = {at_start};\n    0\n}}\n\n\
             /// # Safety\n/// As the header says.\n\
             #[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {prefix}_time(unit: *const Memory) -> f32 {{\n    \
             // SAFETY: the caller's promise.\n    \
             unsafe {{ made(unit) }}.map_or(f32::NAN, |unit| unit.parameters.time(unit.state.steps))\n}}\n"
        );
        for Driven { function, found, command, set_command, .. } in &self.drives {
            let _ = write!(
                text,
                "\n/// # Safety\n/// As the header says.\n#[unsafe(no_mangle)]\n\
                 pub unsafe extern \"C\" fn {prefix}_{command}(unit: *mut Memory, speed: f32) -> i32 {{\n    \
                 // SAFETY: the caller's promise.\n    \
                 if let Err(why) = unsafe {{ made(unit) }} {{\n        return why;\n    }}\n    \
                 let Ok(speed) = slipfit_core::drive::checked_command(speed) else {{ return {OUT_OF_BOUNDS} }};\n    \
                 // SAFETY: it was made, and the caller's promise that nobody else uses it meanwhile.\n    \
                 let Object {{ parameters, .. }} = unsafe {{ (*unit).object.assume_init_mut() }};\n    \
                 {set_command};\n    0\n}}\n"
            );
            let _ = write!(
                text,
                "\n/// # Safety\n/// As the header says.\n#[unsafe(no_mangle)]\n\
                 pub unsafe extern \"C\" fn {prefix}_{function}(unit: *const Memory) -> Driven {{\n    \
                 // SAFETY: the caller's promise.\n    \
                 let Ok(Object {{ parameters, state }}) = (unsafe {{ made(unit) }}) else {{\n        \
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
             * Functions have no state of their own: calls for different units may interrupt each other. The memory of a unit has to be\n \
             * written once before its first use; static memory is. */\n\
             #include <stdint.h>\n\n\
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
             {upper}_OUT_OF_BOUNDS = {OUT_OF_BOUNDS}, /* a gap at level n is, or n: there is no unit then; or a commanded speed */\n    \
             {upper}_HELD = {HELD},          /* the motion left the finite range and was held as it was */\n    \
             {upper}_MISALIGNED = {MISALIGNED},    /* the pointer is not aligned to eight bytes */\n    \
             {upper}_NOT_MADE = {NOT_MADE}       /* {prefix}_init has not made the unit, or failed */\n}};\n\n\
             /* A unit and where it is; {name} keeps its numbers in it, and no pointers: a copy is the unit as it was. */\n\
             typedef struct {{\n    uint64_t words[{words}];\n}} {prefix}_unit;\n\n\
             /* What a drive gives and sees. */\n\
             typedef struct {{\n    float effort; /* N; N m of a drive that turns */\n    \
             float speed;  /* m/s; rad/s of a drive that turns */\n}} {prefix}_driven;\n\n\
             /* Makes *unit one of tolerance level n (-20 to 20, positive is tighter) at the start of the scene's run. */\n\
             int32_t {prefix}_init({prefix}_unit *unit, float n);\n\n\
             /* Moves it by {upper}_STEP: the same instructions whatever its state. */\n\
             int32_t {prefix}_step({prefix}_unit *unit);\n\n\
             /* Back to the start of the scene's run, at time 0; commands that were set stay. */\n\
             int32_t {prefix}_restart({prefix}_unit *unit);\n\n\
             /* Its time (s); NAN where there is no unit, as of its drives below. */\n\
             float {prefix}_time(const {prefix}_unit *unit);\n",
            words = bytes / 8
        );
        for Driven { function, command, name, kind, .. } in &self.drives {
            let name = name.replace("*/", "* /");
            let (effort, speed) = (kind.choose("force (N)", "torque (N m)"), kind.choose("m/s", "rad/s"));
            let _ = write!(
                text,
                "\n/* {effort} and speed ({speed}) of the drive \"{name}\" now. */\n\
                 {prefix}_driven {prefix}_{function}(const {prefix}_unit *unit);\n\n\
                 /* From now on its commanded speed ({speed}, within 1000 either way) is this, in place of the scene's, until another one is set. */\n\
                 int32_t {prefix}_{command}({prefix}_unit *unit, float speed);\n"
            );
        }
        guarded(&format!("{upper}_H"), &(text + "\n#ifdef __cplusplus\n}\n#endif\n"))
    }
}
