//! Manual pages and completions of shells, from the command line's own help.

use std::path::Path;

use clap::Command;
use clap_complete::Shell;

/// Shells that complete commands and options, and where an installation has their files.
const SHELLS: [(Shell, &str); 3] = [
    (Shell::Bash, "share/bash-completion/completions/slipfit"),
    (Shell::Zsh, "share/zsh/site-functions/_slipfit"),
    (Shell::Fish, "share/fish/vendor_completions.d/slipfit.fish"),
];

/// Writes a manual page for the program and for each command, and completions, into a `folder` as /usr is.
///
/// # Errors
/// Files that cannot be written.
pub fn write(command: &Command, folder: &Path) -> anyhow::Result<()> {
    let pages = folder.join("share/man/man1");
    std::fs::create_dir_all(&pages)?;
    // Names of pages have the command's, such as slipfit-simulate.
    let mut command = command.clone().disable_help_subcommand(true);
    command.build();
    clap_mangen::generate_to(command.clone(), &pages)?;
    for (shell, path) in SHELLS {
        let path = folder.join(path);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)?;
        }
        let mut text = Vec::new();
        clap_complete::generate(shell, &mut command, "slipfit", &mut text);
        std::fs::write(path, text)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    #[test]
    fn every_command_has_a_page_and_is_completed() {
        let folder = tempfile::tempdir().unwrap();
        let command = slipfit::cli::command();
        super::write(&command, folder.path()).unwrap();
        let complete = |shell: &str| std::fs::read_to_string(folder.path().join(shell)).unwrap();
        let files = super::SHELLS.map(|(_, path)| complete(path));
        for of in command.get_subcommands() {
            let name = of.get_name();
            let page = std::fs::read_to_string(folder.path().join(format!("share/man/man1/slipfit-{name}.1"))).unwrap();
            assert!(page.contains(".SH SYNOPSIS") && page.contains(".SH OPTIONS"), "{page}");
            assert!(files.iter().all(|text| text.contains(name)), "{name}");
        }
        assert!(folder.path().join("share/man/man1/slipfit.1").exists());
        assert_eq!(
            std::fs::read_dir(folder.path().join("share/man/man1")).unwrap().count(),
            1 + command.get_subcommands().count()
        );
    }

    #[test]
    fn bash_completes_what_is_typed() {
        let folder = tempfile::tempdir().unwrap();
        super::write(&slipfit::cli::command(), folder.path()).unwrap();
        let completions = folder.path().join(super::SHELLS[0].1);
        let completed = |words: &str| {
            let count = words.split(' ').count() - 1;
            let script = format!(
                "source {}; COMP_WORDS=({words}); COMP_CWORD={count}; _slipfit slipfit \"${{COMP_WORDS[{count}]}}\"; echo ${{COMPREPLY[@]}}",
                completions.display()
            );
            let output = Command::new("bash").args(["--norc", "-c", &script]).output().unwrap();
            assert!(output.status.success(), "{output:?}");
            String::from_utf8(output.stdout).unwrap().trim().to_owned()
        };
        assert_eq!(completed("slipfit popu"), "population");
        assert_eq!(completed("slipfit population --uni"), "--units");
    }
}
