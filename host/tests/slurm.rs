//! The guide's scripts on a real SLURM cluster of one machine, which the test starts and stops.

mod common;

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use common::{slipfit, stdout};

/// The page with the scripts.
const PAGE: &str = include_str!("../guide/src/population.md");

/// How long (s) anything may take.
const PATIENCE: u64 = 100;

/// Authentication, controller and node, on ports of their own.
struct Cluster {
    folder: PathBuf,
    daemons: Vec<Child>,
}

/// A daemon of SLURM, installed by Debian's slurm-wlm.
fn daemon(program: &str, folder: &Path, arguments: &[&str]) -> Child {
    // Debian has daemons where not every user looks for them.
    let path = format!("{}:/usr/sbin:/sbin", std::env::var("PATH").unwrap_or_default());
    let log = fs::File::create(folder.join(format!("{program}.out"))).unwrap();
    Command::new("env")
        .arg(format!("PATH={path}"))
        .arg(program)
        .args(arguments)
        .env("SLURM_CONF", folder.join("slurm.conf"))
        .stdout(log.try_clone().unwrap())
        .stderr(log)
        .spawn()
        .expect("SLURM is needed: on Debian, apt-get install slurm-wlm munge")
}

fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

/// A port that nobody listens at.
fn port() -> u16 {
    std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

impl Cluster {
    fn start(folder: &Path) -> Self {
        let folder = folder.to_owned();
        let (host, user) = (said_by("hostname", &["-s"]), said_by("id", &["-un"]));
        let at = |name: &str| folder.join(name).display().to_string();
        fs::create_dir_all(folder.join("state")).unwrap();
        fs::write(folder.join("key"), [7; 128]).unwrap();
        assert_eq!(said_by("chmod", &["600", &at("key")]), "");
        let conf = format!(
            "ClusterName=slipfit\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser={user}\nSlurmdUser={user}\n\
             AuthType=auth/munge\nAuthInfo=socket={munge}\nCredType=cred/munge\nSlurmctldPort={}\nSlurmdPort={}\n\
             StateSaveLocation={state}\nSlurmdSpoolDir={spool}\nSlurmctldPidFile={c}\nSlurmdPidFile={d}\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nReturnToService=2\nMpiDefault=none\n\
             SwitchType=switch/none\nNodeName={host} NodeAddr=127.0.0.1 CPUs=2\n\
             PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP\n",
            port(),
            port(),
            munge = at("munge"),
            state = at("state"),
            spool = at("spool"),
            c = at("slurmctld.pid"),
            d = at("slurmd.pid"),
        );
        fs::write(folder.join("slurm.conf"), conf).unwrap();
        let files = ["key-file=key", "socket=munge", "pid-file=munge.pid", "log-file=munge.log", "seed-file=seed"];
        let files = files.map(|file| {
            let (option, name) = file.split_once('=').unwrap();
            format!("--{option}={}", at(name))
        });
        // `--force`, because the folder may be one that others can write to, as temporary ones are.
        let mut arguments = vec!["--foreground", "--force"];
        arguments.extend(files.iter().map(String::as_str));
        let authentication = daemon("munged", &folder, &arguments);
        await_that("authentication", || folder.join("munge").exists());
        let daemons =
            vec![authentication, daemon("slurmctld", &folder, &["-D", "-c"]), daemon("slurmd", &folder, &["-D"])];
        let cluster = Self { folder, daemons };
        await_that("a node", || cluster.says("sinfo", &["--noheader", "--format=%T"]) == "idle");
        cluster
    }

    /// What a command of SLURM prints.
    fn says(&self, program: &str, arguments: &[&str]) -> String {
        let output = Command::new(program)
            .args(arguments)
            .current_dir(&self.folder)
            .env("SLURM_CONF", self.folder.join("slurm.conf"))
            .stderr(Stdio::null())
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        // The node first: it waits for what it runs.
        for mut daemon in self.daemons.drain(..).rev() {
            let _ = Command::new("kill").arg(daemon.id().to_string()).status();
            let _ = daemon.wait();
        }
    }
}

fn await_that(what: &str, happens: impl Fn() -> bool) {
    let start = Instant::now();
    while !happens() {
        assert!(start.elapsed() < Duration::from_secs(PATIENCE), "{what} does not come");
        sleep(Duration::from_millis(100));
    }
}

/// The guide's script with this `line` in it, for a smaller population and the program under test.
fn script(line: &str) -> String {
    let scripts = PAGE.split("```").filter(|block| block.starts_with("console\n#!/bin/sh"));
    let found: Vec<_> = scripts.filter(|block| block.contains(line)).collect();
    let [script] = found[..] else { panic!("{line}: {found:?}") };
    let script = script
        .trim_start_matches("console\n")
        .replace("my-slide.toml --units 10000000", "cd-rom-slide --units 60000 --opening");
    script
        .replace("--array=1-100", "--array=1-3")
        .replace("cpus-per-task=4", "cpus-per-task=1")
        .replace("\nslipfit", &format!("\n{}", env!("CARGO_BIN_EXE_slipfit")))
}

/// The submitted tasks, one of which is started again, and the job that merges them end in what one run prints.
#[test]
fn tasks_of_an_array_are_merged_into_the_bytes_of_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let cluster = Cluster::start(folder.path());
    for (name, line) in [("submit.sh", "--shard auto"), ("merge.sh", "slipfit merge")] {
        fs::write(folder.path().join(name), script(line)).unwrap();
    }
    let job = cluster.says("sbatch", &["--parsable", "submit.sh"]);
    assert!(job.parse::<u32>().is_ok(), "{job}");
    let merged = cluster.says("sbatch", &["--parsable", &format!("--dependency=afterok:{job}"), "merge.sh"]);
    // As if its node had failed: a task begins again, at once.
    let task = format!("{job}_1");
    await_that("a task", || cluster.says("squeue", &["--noheader", "--states=R", "--format=%i"]).contains(&task));
    cluster.says("scontrol", &["requeue", &task]);
    // Else it would wait for two minutes; while it still ends, nothing can be changed.
    await_that("the task again", || {
        cluster.says("scontrol", &["update", &format!("jobid={task}"), "starttime=now"]);
        let told = cluster.says("scontrol", &["show", "job", &task]);
        told.contains("Restarts=1") && (told.contains("JobState=RUNNING") || told.contains("JobState=COMPLETED"))
    });
    await_that("the end", || cluster.says("squeue", &["--noheader", "--format=%i"]).is_empty());
    let log = fs::read_to_string(folder.path().join(format!("slurm-{merged}.out"))).unwrap_or_default();
    let found = fs::read_to_string(folder.path().join("population.json")).unwrap();
    let whole =
        stdout(&slipfit(folder.path(), &["population", "cd-rom-slide", "--units", "60000", "--opening", "--json"]));
    assert!(found == whole, "{log}{found}");
}
