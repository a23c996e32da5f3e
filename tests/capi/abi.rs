//! What a program and the library have to agree on, and what strict compilers say of the header and the example.

use std::{fmt::Write, fs, path::Path, process::Command};

use slipfit_tests::cross::{finished, printed};

use super::{EXAMPLE, FOLDER, ROOT, compiler, compiler_for_target, library, on_target};

/// The header's structs, each with the names of its fields.
fn structs() -> Vec<(String, Vec<String>)> {
    let header = fs::read_to_string(Path::new(ROOT).join("core/capi/include/slipfit.h")).expect("a file");
    let structs = header.split("typedef struct ").skip(1).filter_map(|text| {
        let (name, rest) = text.split_once(" {\n")?;
        let fields = rest.split_once('}')?.0.lines().filter(|line| line.ends_with(';'));
        let field = |line: &str| {
            let declared = line.trim_end_matches(';').split('[').next().unwrap_or_default();
            declared.rsplit([' ', '*']).next().unwrap_or_default().to_owned()
        };
        Some((name.to_owned(), fields.map(field).collect()))
    });
    structs.collect()
}

/// A program that prints the size of every struct and where each of its fields lies.
fn program() -> String {
    let mut text = String::from(
        "#include <stddef.h>\n#include \"slipfit.h\"\n\nvoid put(const char *text);\n\n\
         static void put_number(const char *name, uint32_t number) {\n    char text[12];\n    char *digit = text + 11;\n    *digit = 0;\n    \
         *--digit = '\\n';\n    do {\n        *--digit = (char)('0' + number % 10u);\n        number /= 10u;\n    } while (number != 0u);\n    \
         put(name);\n    put(\" \");\n    put(digit);\n}\n\nint main(void) {\n",
    );
    for (name, fields) in structs() {
        let _ = writeln!(text, "    put_number(\"{name}\", (uint32_t)sizeof({name}));");
        for field in fields {
            let _ = writeln!(text, "    put_number(\"  .{field}\", (uint32_t)offsetof({name}, {field}));");
        }
    }
    text + "    return 0;\n}\n"
}

/// Sizes and places, which a version of the library keeps. What has no pointers is the same on the PC and on the target.
#[test]
fn structs_are_laid_out_as_recorded() {
    let source = Path::new(FOLDER).join("abi.c");
    fs::write(&source, program()).expect("the test's folder takes files");
    let (desk, target) = (Path::new(FOLDER).join("abi"), Path::new(FOLDER).join("abi.elf"));
    let mut host = compiler("cc");
    host.arg(&source).args(["core/capi/examples/desk.c", "-o"]).arg(&desk);
    printed(&mut host);
    printed(compiler_for_target(&source, &target).arg("-lgcc"));
    let (on_host, on_target) = (printed(&mut Command::new(&desk)), on_target(&target));
    let without_slots = |text: &str| {
        let slots = text.split_once("slipfit_slots ").expect("a struct with pointers");
        slots.0.to_owned() + slots.1.split_once("slipfit_spare").expect("the next").1
    };
    assert_eq!(without_slots(&on_host), without_slots(&on_target));
    insta::assert_snapshot!("abi", on_target);
}

/// All of clang's warnings but those of a style: the header's comments are of C99, structs have room at their end, C++11 is new, and
/// functions that take pointers are unsafe.
#[test]
fn every_warning_of_clang_is_answered() {
    // A clang need not know all of these.
    let strict = [
        "-fsyntax-only",
        "-Weverything",
        "-Werror",
        "-Wno-unknown-warning-option",
        "-Wno-padded",
        "-Wno-unsafe-buffer-usage",
    ];
    for (language, standard, more) in [
        ("c", "-std=c11", &["-Wno-declaration-after-statement", "-Wno-pre-c11-compat"][..]),
        ("c++", "-std=c++17", &["-Wno-c++98-compat", "-Wno-c++98-compat-pedantic"]),
    ] {
        let mut clang = Command::new("clang");
        clang.current_dir(ROOT).args(strict).args(more).args(["-x", language, standard, "-Icore/capi/include"]);
        let header = Path::new(FOLDER).join(format!("all.{}", if language == "c" { "c" } else { "cpp" }));
        let used = "#include \"slipfit.h\"\nint main(void);\nint main(void) { return slipfit_check_header(SLIPFIT_VERSION, SLIPFIT_LAYOUT); }\n";
        fs::write(&header, used).expect("the test's folder takes files");
        let output = finished(clang.arg(&header));
        assert!(output.status.success(), "{language}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// The example prints the same under the sanitizers of addresses and of undefined behaviour, which end what is wrong.
#[test]
fn sanitizers_find_nothing() {
    let (plain, sanitized) = (Path::new(FOLDER).join("plain"), Path::new(FOLDER).join("sanitized"));
    let archive = library("sanitized", &[]);
    let build = |options: &[&str], program: &Path| {
        let mut compiler = compiler("cc");
        compiler.args(options).args([EXAMPLE, "core/capi/examples/desk.c", "-o"]);
        printed(compiler.arg(program).arg(&archive))
    };
    build(&[], &plain);
    build(&["-fsanitize=address,undefined", "-fno-sanitize-recover=all"], &sanitized);
    assert_eq!(printed(&mut Command::new(&plain)), printed(&mut Command::new(&sanitized)));
}
