//! Ranks on two hosts: network namespaces with their own names and addresses, between which messages go by TCP.
//!
//! Making them needs root and `ip`; where that is not allowed the tests say so and show nothing, but in CI, where they fail.

use std::path::Path;
use std::process::{Command, Output};

use crate::ends::{end_of, long, signal, wait_for_a_checkpoint};
use crate::launched::{assert_same, on_one, report, run, said};

/// Two hosts, gone when they are dropped.
struct Hosts {
    names: [String; 2],
    /// What `mpirun` starts in place of `ssh`.
    agent: std::path::PathBuf,
}

/// Addresses, in a network that both have to themselves.
const ADDRESSES: [&str; 2] = ["10.77.0.1", "10.77.0.2"];

fn ip(arguments: &str) -> Result<(), String> {
    let output = Command::new("ip").args(arguments.split(' ')).output();
    let output = output.map_err(|cause| format!("`ip` cannot be started: {cause}"))?;
    let told = || format!("ip {arguments}: {}", String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(()) } else { Err(told()) }
}

impl Hosts {
    /// Two hosts of these names, joined by a cable.
    fn make(folder: &Path, names: [&str; 2]) -> Result<Self, String> {
        let names = names.map(|name| format!("{name}-{}", std::process::id()));
        let [a, b] = &names;
        let agent = folder.join("agent");
        let text = format!(
            "#!/bin/bash\nhost=$1\nshift\ncase $host in {}) host={a} ;; {}) host={b} ;; esac\n\
             exec ip netns exec $host unshare -u bash -c \"hostname $host; $*\"\n",
            ADDRESSES[0], ADDRESSES[1]
        );
        std::fs::write(&agent, text).map_err(|cause| cause.to_string())?;
        let made = Command::new("chmod").arg("755").arg(&agent).status();
        made.map_err(|cause| cause.to_string())?;
        ip(&format!("netns add {a}"))?;
        let hosts = Self { names: names.clone(), agent };
        ip(&format!("netns add {b}"))?;
        ip(&format!("link add cable netns {a} type veth peer name cable netns {b}"))?;
        for (name, address) in names.iter().zip(ADDRESSES) {
            ip(&format!("-n {name} addr add {address}/24 dev cable"))?;
            ip(&format!("-n {name} link set lo up"))?;
            ip(&format!("-n {name} link set cable up"))?;
        }
        Ok(hosts)
    }

    /// `mpirun` on the first host, of two ranks on each.
    fn mpirun(&self) -> Command {
        let hosts = ADDRESSES.map(|address| format!("{address}:2")).join(",");
        let line = format!(
            "hostname {}; exec mpirun --allow-run-as-root --host {hosts} --mca plm_rsh_agent {} --mca btl \
             tcp,vader,self --mca btl_tcp_if_include 10.77.0.0/24 --mca oob_tcp_if_include 10.77.0.0/24 --bind-to none \
             --mca mpi_yield_when_idle 1 -n 4 \"$@\"",
            self.names[0],
            self.agent.display()
        );
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.names[0], "unshare", "-u", "bash", "-c", &line, "mpirun"]);
        command.arg(env!("CARGO_BIN_EXE_weald-mpi"));
        command
    }

    /// Processes of `weald-mpi` on the second host.
    fn ranks_of_the_second(&self) -> Vec<u32> {
        let output = Command::new("ip").args(["netns", "pids", &self.names[1]]).output();
        let output = output.expect("`ip` made the host");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let numbers = text.lines().filter_map(|line| line.trim().parse::<u32>().ok());
        let is_rank = |number: &u32| {
            let name = std::fs::read_to_string(format!("/proc/{number}/comm")).unwrap_or_default();
            name.trim() == "weald-mpi"
        };
        numbers.filter(is_rank).collect()
    }

    /// Bytes that have come to the second host.
    fn bytes_received(&self) -> u64 {
        let reading = ["netns", "exec", &self.names[1], "cat", "/proc/net/dev"];
        let output = Command::new("ip").args(reading).output().expect("`ip` made the host");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let counted = text.lines().find_map(|line| line.trim().strip_prefix("cable:").map(str::to_owned));
        counted.and_then(|line| line.split_whitespace().next()?.parse().ok()).expect("the cable is counted")
    }
}

impl Drop for Hosts {
    fn drop(&mut self) {
        for name in &self.names {
            // One that was never made need not go.
            let _ = ip(&format!("netns del {name}"));
        }
    }
}

/// The hosts, where they may be made.
fn hosts(folder: &Path, names: [&str; 2]) -> Option<Hosts> {
    match Hosts::make(folder, names) {
        Ok(hosts) => Some(hosts),
        Err(what) if std::env::var_os("CI").is_none() => {
            eprintln!("left out, since two hosts cannot be made here: {what}");
            None
        }
        Err(what) => panic!("{what}"),
    }
}

#[test]
fn ranks_on_two_hosts_make_the_files_of_one_processor_and_one_that_is_killed_ends_all() {
    let folder = long(1);
    let Some(hosts) = hosts(folder.path(), ["north", "south"]) else { return };
    let expected = on_one(folder.path());
    let more = ["run", "r.toml", "--threads", "1", "--out"];
    let output: Output =
        hosts.mpirun().current_dir(folder.path()).args(more).arg("two").output().expect("it starts");
    assert!(output.status.success(), "{}", said(&output));
    assert_same(folder.path(), &expected, "two");
    // Halos of 2,100 steps of five planes, and half of the state.
    let received = hosts.bytes_received();
    assert!(received > 5_000_000, "only {received} bytes went over the cable");
    let stderr = std::fs::File::create(folder.path().join("stderr")).expect("a file");
    let mut command = hosts.mpirun();
    command.current_dir(folder.path()).args(more).args(["parts", "--checkpoint-every", "0"]).stderr(stderr);
    let running = command.spawn().expect("it starts");
    wait_for_a_checkpoint(folder.path(), None);
    signal("KILL", hosts.ranks_of_the_second().pop().expect("there are ranks"));
    assert!(!end_of(running).success());
    let said_by_run = std::fs::read_to_string(folder.path().join("stderr")).expect("read");
    assert!(said_by_run.contains("exited on signal 9 (Killed)"), "{said_by_run}");
    let output = run(3, folder.path(), "parts", &["--resume"]);
    assert!(output.status.success(), "{}", said(&output));
    assert_same(folder.path(), &expected, "parts");
    assert_eq!(report(folder.path(), "parts").engine, "ranks");
}
