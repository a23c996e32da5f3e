//! A step of the shipped slide on one emulated core after another: the bits of the PC on all of them, and what it takes.

use std::{fmt::Write, path::Path, process::Command, sync::LazyLock};

use slipfit_firmware::{desk::Desk, slide::Steps};
use slipfit_tests::{
    cross::{self, printed},
    guide::{self, with_comma},
};

/// Its own, so that other images need not wait for these.
const FOLDER: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/cores");

/// What an image is built for, and the board that it runs on.
struct Core {
    name: &'static str,
    target: &'static str,
    /// As in `-C target-cpu`, where it is not the target's own.
    cpu: Option<&'static str>,
    machine: &'static str,
}

/// Those with a floating-point unit come first.
const CORES: [Core; 8] = [
    Core { name: "Cortex-M4F", target: "thumbv7em-none-eabihf", cpu: Some("cortex-m4"), machine: "mps2-an386" },
    Core { name: "Cortex-M4F", target: "thumbv7em-none-eabihf", cpu: None, machine: "mps2-an386" },
    Core { name: "Cortex-M7", target: "thumbv7em-none-eabihf", cpu: Some("cortex-m7"), machine: "mps2-an500" },
    Core { name: "Cortex-M33", target: "thumbv8m.main-none-eabihf", cpu: None, machine: "mps2-an505" },
    Core { name: "RISC-V", target: "riscv32imafc-unknown-none-elf", cpu: None, machine: "virt" },
    Core { name: "Cortex-M4", target: "thumbv7em-none-eabi", cpu: None, machine: "mps2-an386" },
    Core { name: "Cortex-M3", target: "thumbv7m-none-eabi", cpu: None, machine: "mps2-an385" },
    Core { name: "Cortex-M0", target: "thumbv6m-none-eabi", cpu: None, machine: "microbit" },
];

/// What an image said of a step, and the size of its code.
struct Costs {
    least: u32,
    greatest: u32,
    stack: u32,
    object: u32,
    states: String,
    code: u32,
    /// The most instructions of a lookup with floating point, and in integers.
    lookups: [u32; 2],
}

impl Core {
    fn costs(&self) -> Costs {
        let image = cross::image_for(FOLDER, self.target, self.cpu);
        let text = printed(self.emulator().arg("-kernel").arg(&image));
        let words: Vec<_> = text.split_whitespace().collect();
        let [least, greatest, stack, object, states, _, float, _, integers] = words[..] else { panic!("{text}") };
        let number = |word: &str| word.parse().expect("a number");
        Costs {
            least: number(least),
            greatest: number(greatest),
            stack: number(stack),
            object: number(object),
            states: states.to_owned(),
            code: code(&image),
            lookups: [float, integers].map(number),
        }
    }

    /// An emulator of the board that ends an image that hangs.
    fn emulator(&self) -> Command {
        // An instruction takes 2^7 ns, which the boards' counts rely on; what counts instructions by itself tells ns.
        let (program, clock) = match self.machine {
            "virt" => ("qemu-system-riscv32", "shift=0"),
            _ => ("qemu-system-arm", "shift=7"),
        };
        let mut emulator = Command::new("timeout");
        emulator.args(["60", program, "-machine", self.machine, "-bios", "none", "-nographic", "-icount", clock]);
        emulator.args(["-semihosting-config", "enable=on,target=native"]);
        emulator
    }
}

/// Bytes of the step's code in `image`, without the compiler's routines that compute in software.
fn code(image: &Path) -> u32 {
    cross::require_c_compiler();
    let symbols = printed(Command::new("arm-none-eabi-nm").args(["--print-size", "--demangle"]).arg(image));
    let steps = symbols.lines().filter(|line| line.ends_with("::step"));
    let size = |line: &str| u32::from_str_radix(line.split(' ').nth(1)?, 16).ok();
    steps.map(|line| size(line).expect("a size")).sum()
}

/// The costs on every core.
static COSTS: LazyLock<Vec<Costs>> = LazyLock::new(|| {
    cross::require_emulator();
    cross::require_emulator_of("riscv32", "qemu-system-misc");
    CORES.iter().map(Core::costs).collect()
});

impl Costs {
    /// The instructions of a step, with their range where it varies.
    fn instructions(&self, number: fn(u32) -> String) -> String {
        let [least, greatest] = [self.least, self.greatest].map(number);
        if least == greatest { least } else { format!("{least} to {greatest}") }
    }
}

#[test]
#[ignore = "builds images of eight cores: `cargo verify --all`"]
fn every_core_has_the_bits_of_the_pc() {
    let on_pc = Steps::on(&mut Desk).states.to_string();
    let mut table = String::from(
        "core        target                         target-cpu  instructions of a step  code B  stack B  object B  lookup, f32  i32\n",
    );
    for (Core { name, target, cpu, .. }, costs) in CORES.iter().zip(&*COSTS) {
        assert_eq!(costs.states, on_pc, "{name}, {target}");
        let (cpu, count) = (cpu.unwrap_or("-"), costs.instructions(|count| count.to_string()));
        // No instruction of these branches on numbers. RISC-V has none that selects without a branch.
        assert!(costs.least == costs.greatest || !target.ends_with("eabihf"), "{name}: {count}");
        let Costs { code, stack, object, lookups: [float, integers], .. } = costs;
        // Without a floating-point unit, integers are what a lookup has time for.
        assert!(*integers <= 400, "{name}: {integers}");
        // The image for RISC-V does not measure its stack.
        let stack = if *stack == 0 { "-".to_owned() } else { stack.to_string() };
        let _ = writeln!(
            table,
            "{name:10}  {target:29}  {cpu:10}  {count:>22}  {code:6}  {stack:>7}  {object:8}  {float:11}  {integers:3}"
        );
    }
    insta::assert_snapshot!("steps", table);
}

#[test]
#[ignore = "builds images of eight cores: `cargo verify --all`"]
fn the_guide_has_these_costs() {
    let page = guide::page("firmware");
    for (Core { name, target, cpu, .. }, costs) in CORES.iter().zip(&*COSTS) {
        let cpu = cpu.map_or("none".to_owned(), |cpu| format!("`{cpu}`"));
        let (count, code) = (costs.instructions(with_comma), with_comma(costs.code));
        let stack = if costs.stack == 0 { "not measured".to_owned() } else { costs.stack.to_string() };
        let [float, integers] = costs.lookups.map(with_comma);
        let row = format!("| {name} | `{target}` | {cpu} | {count} | {code} | {stack} | {float} | {integers} |");
        assert!(page.contains(&row), "{row}");
    }
}
