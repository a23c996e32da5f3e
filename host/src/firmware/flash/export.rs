//! A table as a file: raw, Intel hex, a C header or Rust source.

use std::fmt::Write;

use ihex::Record;
use slipfit_core::table::{AxisKind, Encoding, MotionVerdict, layout};

use crate::firmware::guard::{c_name, guarded};

/// What can be written, by a file's extension.
pub const EXTENSIONS: [&str; 4] = ["bin", "hex", "h", "rs"];

/// Why a table is not written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// No format has this extension.
    #[error("a table is not written as {found:?}; allowed are .{}", EXTENSIONS.join(", ."))]
    Extension {
        /// The extension found.
        found: String,
    },
    /// The table would end beyond the last address.
    #[error("{bytes} bytes from address {base:#010x} on exceed 32-bit addresses")]
    Address {
        /// Where it is to start.
        base: u32,
        /// Its length.
        bytes: usize,
    },
    /// The hex file's records do not make a file.
    #[error("Intel hex: {0}")]
    Hex(#[from] ihex::WriterError),
}

/// The content of a file with `extension` (without its dot, in any case) that holds `table`. Names in a C header follow the `stem` of
/// the file's name: in `table.h` the bytes are `slipfit_table_bytes`, and their number `SLIPFIT_TABLE_SIZE`.
///
/// `base` is the address the table is flashed to; only Intel hex says it.
///
/// # Errors
/// [`ExportError`] if no format has the extension or the table does not fit behind `base`.
pub fn render(stem: &str, extension: &str, table: &[u8], base: u32) -> Result<Vec<u8>, ExportError> {
    match extension.to_ascii_lowercase().as_str() {
        "bin" => Ok(table.to_vec()),
        "hex" => Ok(hex(table, base)?.into_bytes()),
        "h" => Ok(c_header(stem, table).into_bytes()),
        "rs" => Ok(rust_source(table).into_bytes()),
        _ => Err(ExportError::Extension { found: extension.to_owned() }),
    }
}

/// Data records of up to 16 bytes, aligned to 16, so that none crosses a 64 KB boundary.
fn hex(table: &[u8], base: u32) -> Result<String, ExportError> {
    if u64::from(base) + table.len() as u64 > 1 << 32 {
        return Err(ExportError::Address { base, bytes: table.len() });
    }
    let mut records = Vec::new();
    let mut segment = None;
    let (mut address, mut rest) = (base, table);
    while !rest.is_empty() {
        let upper = (address >> 16) as u16;
        if segment != Some(upper) {
            records.push(Record::ExtendedLinearAddress(upper));
            segment = Some(upper);
        }
        let (value, after) = rest.split_at(rest.len().min(16 - (address % 16) as usize));
        records.push(Record::Data { offset: address as u16, value: value.to_vec() });
        address = address.wrapping_add(value.len() as u32);
        rest = after;
    }
    records.push(Record::EndOfFile);
    Ok(ihex::create_object_file_representation(&records)? + "\n")
}

/// What a C program needs in order to read a table: macros from the one description of the layout, then the bytes.
fn c_header(stem: &str, table: &[u8]) -> String {
    let name = c_name(stem);
    let upper = name.to_uppercase();
    let mut text = String::from(C_INTRODUCTION);
    let mut define = |name: &str, value: usize| {
        let _ = writeln!(text, "#define SLIPFIT_TABLE_{name} {value}u");
    };
    define("FORMAT_VERSION", layout::VERSION.into());
    define("MAGIC_AT", layout::MAGIC_AT);
    define("VERSION_AT", layout::VERSION_AT);
    define("AXIS_COUNT_AT", layout::AXIS_COUNT_AT);
    define("ENCODING_AT", layout::ENCODING_AT);
    define("SCENE_HASH_AT", layout::SCENE_HASH_AT);
    define("LENGTH_AT", layout::LENGTH_AT);
    define("AXES_AT", layout::AXES_AT);
    define("AXES_MOST", layout::AXES_MOST);
    define("AXIS_SIZE", layout::AXIS_SIZE);
    define("AXIS_KIND_AT", layout::AXIS_KIND_AT);
    define("AXIS_NODES_AT", layout::AXIS_NODES_AT);
    define("AXIS_FIRST_AT", layout::AXIS_FIRST_AT);
    define("AXIS_STEP_AT", layout::AXIS_STEP_AT);
    for kind in AxisKind::ALL {
        define(&format!("AXIS_{}", format!("{kind:?}").to_uppercase()), kind as usize);
    }
    define("CHANNELS_AT", layout::CHANNELS_AT);
    define("CHANNELS", layout::CHANNELS);
    define("CHANNEL_SIZE", layout::CHANNEL_SIZE);
    define("CHANNEL_SCALE_AT", layout::CHANNEL_SCALE_AT);
    define("CHANNEL_WORST_AT", layout::CHANNEL_WORST_AT);
    define("CHANNEL_RMS_AT", layout::CHANNEL_RMS_AT);
    for encoding in Encoding::ALL {
        define(&format!("ENCODING_{encoding:?}"), encoding as usize);
    }
    define("DATA_AT", layout::HEADER_SIZE);
    for verdict in MotionVerdict::ALL {
        define(verdict.name().to_uppercase().as_str(), verdict as usize);
    }
    define("CHECKSUM_SIZE", layout::CHECKSUM_SIZE);
    let _ = writeln!(text, "#define SLIPFIT_{upper}_SIZE {}u", table.len());
    // Firmware compares it with the hash in the table that it finds.
    let _ = writeln!(text, "#define SLIPFIT_{upper}_SCENE_HASH 0x{}ull", hash(table));
    let array = array(table);
    let _ = write!(
        text,
        "\n#if defined(__GNUC__)\n__attribute__((aligned(4), unused))\n#endif\n\
         static const uint8_t slipfit_{name}_bytes[SLIPFIT_{upper}_SIZE] = {{\n{array}}};\n"
    );
    guarded(&format!("SLIPFIT_{upper}_H"), &text)
}

/// The hash that a table is stamped with, in hexadecimal.
fn hash(table: &[u8]) -> String {
    let hash = table.get(layout::SCENE_HASH_AT..layout::LENGTH_AT).unwrap_or_default();
    hash.iter().rev().map(|byte| format!("{byte:02x}")).collect()
}

const C_INTRODUCTION: &str = "\
/* A slipfit flash table: force and velocity over a grid.
 *
 * Numbers are little-endian. Offsets count bytes from the start of the table; those of an axis or channel, from the
 * start of its record. The table starts with the magic \"SLFT\" and these fields:
 *   version u16, axis count u8, encoding u8, scene hash u64, length u32 (up to the end of the checksum);
 *   AXES_MOST axis records: kind u8, 3 zero bytes, nodes u32, first f32, step f32; absent axes are all zero;
 *   CHANNELS channel records, force (N) and velocity (m/s): scale f32, worst interpolation error f32, root mean square
 *   of that error f32.
 * From DATA_AT on come force and velocity of each node, the last axis fastest, and one more node that weighs nothing. A
 * value is the stored f32 or i16 times the channel's scale. Then comes a byte for every motion, for each node of all axes but
 * the second: twice its verdict (UNDECIDED, RUNS, CRAWLS, JAMMED), plus 1 if the motion at the next node of the first axis
 * has another one, so that values between them are those of no unit; zero bytes fill up to a multiple of 4. The last
 * CHECKSUM_SIZE bytes are the CRC-32/ISO-HDLC of everything before them. Axes are in
 * units of n (LEVEL), s (TIME), m (POSITION), m/s (VELOCITY).
 */
#include <stdint.h>

";

/// A module's source with the table as `SLIPFIT_TABLE`.
fn rust_source(table: &[u8]) -> String {
    let (size, hash) = (table.len(), hash(table));
    format!(
        "// A slipfit flash table: force and velocity over a grid, for `slipfit_core::table::Table::open`.\n\n\
         /// What it is stamped with; to be compared with the scene's `SCENE_HASH`.\npub const SLIPFIT_TABLE_HASH: u64 = 0x{hash};\n\n\
         #[repr(C, align(4))]\nstruct Aligned([u8; {size}]);\n\n\
         /// The table, at an address that is a multiple of 4.\n\
         pub static SLIPFIT_TABLE: &[u8; {size}] = &ALIGNED.0;\n\n\
         #[rustfmt::skip]\nstatic ALIGNED: Aligned = Aligned([\n{}]);\n",
        array(table)
    )
}

/// The elements of an array, 16 a line, as C and Rust both write them.
fn array(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() * 6 + 64);
    for line in bytes.chunks(16) {
        text += "   ";
        for byte in line {
            let _ = write!(text, " {byte:#04x},");
        }
        text += "\n";
    }
    text
}

#[cfg(test)]
mod tests {
    use std::{fs, path::Path, process::Command};

    use ihex::{Reader, Record};
    use slipfit_core::table::Encoding;

    use super::{ExportError, render};
    use crate::firmware::flash::{TABLE_ADDRESS, encode, tests::small};

    fn table() -> Vec<u8> {
        encode(&small(3, Encoding::I16)).unwrap()
    }

    /// Runs `command` to its successful end and gives what it printed.
    fn output(command: &mut Command) -> Vec<u8> {
        let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
        assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    }

    /// The bytes and the address that a hex file says.
    fn parsed(text: &str) -> (u32, Vec<u8>) {
        let (mut upper, mut start, mut bytes) = (0, None, Vec::new());
        for record in Reader::new(text) {
            match record.unwrap() {
                Record::ExtendedLinearAddress(segment) => upper = u32::from(segment) << 16,
                Record::Data { offset, value } => {
                    let address = upper + u32::from(offset);
                    assert_eq!(address, *start.get_or_insert(address) + bytes.len() as u32);
                    bytes.extend(value);
                }
                record => assert_eq!(record, Record::EndOfFile),
            }
        }
        (start.unwrap(), bytes)
    }

    #[test]
    fn bin_is_the_table() {
        assert_eq!(render("table", "BIN", &table(), 0).unwrap(), table());
    }

    #[test]
    fn hex_reads_back() {
        let long: Vec<u8> = (0..200_000u32).map(|i| (i % 251) as u8).collect();
        let end = u32::MAX - (table().len() as u32 - 1);
        for (bytes, base) in [(&table(), TABLE_ADDRESS), (&long, 0x0807_fff3), (&table(), end)] {
            let text = render("table", "hex", bytes, base).unwrap();
            assert_eq!(parsed(std::str::from_utf8(&text).unwrap()), (base, bytes.clone()));
        }
        let (base, bytes) = (end + 1, table().len());
        assert_eq!(render("table", "hex", &table(), base), Err(ExportError::Address { base, bytes }));
    }

    #[test]
    fn c_header_compiles_and_holds_the_table() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        fs::write(path("table.h"), render("table", "h", &table(), 0).unwrap()).unwrap();
        fs::write(path("main.c"), C_PROGRAM).unwrap();
        let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"];
        output(Command::new("cc").args(strict).arg("-fsyntax-only").arg(path("table.h")));
        output(Command::new("cc").args(strict).arg(path("main.c")).arg("-o").arg(path("main")));
        assert_eq!(output(&mut Command::new(path("main"))), table());
    }

    /// Writes the table and succeeds, if the macros point at what they say.
    const C_PROGRAM: &str = r#"
        #include "table.h"
        #include <stdio.h>
        #include <string.h>

        int main(void) {
            const uint8_t *length = slipfit_table_bytes + SLIPFIT_TABLE_LENGTH_AT;
            fwrite(slipfit_table_bytes, 1, sizeof slipfit_table_bytes, stdout);
            return memcmp(slipfit_table_bytes + SLIPFIT_TABLE_MAGIC_AT, "SLFT", 4) != 0
                || slipfit_table_bytes[SLIPFIT_TABLE_VERSION_AT] != SLIPFIT_TABLE_FORMAT_VERSION
                || length[0] + 256u * length[1] != SLIPFIT_TABLE_SIZE
                || slipfit_table_bytes[SLIPFIT_TABLE_AXES_AT + SLIPFIT_TABLE_AXIS_KIND_AT] != SLIPFIT_TABLE_AXIS_LEVEL
                || slipfit_table_bytes[SLIPFIT_TABLE_ENCODING_AT] != SLIPFIT_TABLE_ENCODING_I16
                || (uintptr_t)slipfit_table_bytes % 4 != 0;
        }
    "#;

    #[test]
    fn rust_source_compiles_and_holds_the_table() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        fs::write(path("table.rs"), render("table", "rs", &table(), 0).unwrap()).unwrap();
        fs::write(path("main.rs"), RUST_PROGRAM).unwrap();
        let rustc = Path::new(env!("CARGO")).with_file_name("rustc");
        output(
            Command::new(rustc).args(["--edition=2024", "-Dwarnings"]).arg(path("main.rs")).arg("-o").arg(path("main")),
        );
        assert_eq!(output(&mut Command::new(path("main"))), table());
    }

    #[test]
    fn a_program_includes_two_tables() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        let other = encode(&small(2, Encoding::F32)).unwrap();
        fs::write(path("table.h"), render("table", "h", &table(), 0).unwrap()).unwrap();
        fs::write(path("Other-1.h"), render("Other-1", "h", &other, 0).unwrap()).unwrap();
        let program = "#include \"table.h\"\n#include \"Other-1.h\"\n#include \"table.h\"\n#include <stdio.h>\n\
            int main(void) {\n    fwrite(slipfit_table_bytes, 1, SLIPFIT_TABLE_SIZE, stdout);\n    \
            fwrite(slipfit_other_1_bytes, 1, SLIPFIT_OTHER_1_SIZE, stdout);\n    return 0;\n}\n";
        fs::write(path("main.c"), program).unwrap();
        let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"];
        output(Command::new("cc").args(strict).arg(path("main.c")).arg("-o").arg(path("main")));
        assert_eq!(output(&mut Command::new(path("main"))), [table(), other].concat());
        // Of the same name in another folder: refused, not dropped.
        fs::create_dir(path("b")).unwrap();
        fs::write(path("b/table.h"), render("table", "h", &encode(&small(2, Encoding::F32)).unwrap(), 0).unwrap())
            .unwrap();
        fs::write(path("both.c"), "#include \"table.h\"\n#include \"b/table.h\"\n").unwrap();
        assert!(
            !Command::new("cc")
                .arg("-c")
                .arg(path("both.c"))
                .arg("-o")
                .arg(path("o"))
                .output()
                .unwrap()
                .status
                .success()
        );
    }

    const RUST_PROGRAM: &str = r#"
        mod table;

        fn main() -> std::io::Result<()> {
            assert_eq!(table::SLIPFIT_TABLE.as_ptr().addr() % 4, 0);
            assert_eq!(table::SLIPFIT_TABLE_HASH.to_le_bytes(), table::SLIPFIT_TABLE[8..16]);
            std::io::Write::write_all(&mut std::io::stdout(), table::SLIPFIT_TABLE)
        }
    "#;

    #[test]
    fn other_extensions_are_named() {
        let error = render("table", "elf", &table(), 0).unwrap_err();
        assert_eq!(error.to_string(), r#"a table is not written as "elf"; allowed are .bin, .hex, .h, .rs"#);
    }
}
