//! A stage of the work: this program as a process of its own, so that it can be stopped at any moment.

use std::{
    ffi::OsString,
    fs::File,
    io::{Read, Seek},
    process::{Child, Command, Stdio},
};

/// A process that works on a stage. It ends with its owner.
pub struct Stage {
    child: Child,
    stdout: File,
    stderr: File,
}

/// What a stage has come to.
#[derive(Debug, PartialEq)]
pub struct Done {
    /// Whether it has done its work.
    pub success: bool,
    /// What it printed.
    pub stdout: String,
    /// Errors and warnings.
    pub stderr: String,
}

impl Stage {
    /// Starts this program with these `arguments`; by `program`, if it is not what runs now.
    ///
    /// # Errors
    /// If there is no process or no temporary file to be had.
    pub fn start(program: &[OsString], arguments: &[String]) -> std::io::Result<Self> {
        let [stdout, stderr] = [tempfile::tempfile()?, tempfile::tempfile()?];
        let mut command = match program {
            [] => Command::new(std::env::current_exe()?),
            [program, first @ ..] => {
                let mut command = Command::new(program);
                command.args(first);
                command
            }
        };
        command.args(arguments).stdin(Stdio::null()).stdout(stdout.try_clone()?).stderr(stderr.try_clone()?);
        Ok(Self { child: command.spawn()?, stdout, stderr })
    }

    /// What it has come to; none while it works.
    ///
    /// # Errors
    /// If the system does not tell.
    pub fn done(&mut self) -> std::io::Result<Option<Done>> {
        let Some(status) = self.child.try_wait()? else { return Ok(None) };
        let text = |file: &mut File| {
            let mut bytes = Vec::new();
            file.rewind()?;
            file.read_to_end(&mut bytes)?;
            std::io::Result::Ok(String::from_utf8_lossy(&bytes).into_owned())
        };
        let (stdout, mut stderr) = (text(&mut self.stdout)?, text(&mut self.stderr)?);
        if !status.success() && stderr.trim().is_empty() {
            let folder = std::env::temp_dir();
            stderr = format!("error: a computation ended ({status}) without a message; is {} full?", folder.display());
        }
        Ok(Some(Done { success: status.success(), stdout, stderr }))
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        // Fails if it has ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
