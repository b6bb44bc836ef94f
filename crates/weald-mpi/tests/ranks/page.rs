//! The commands of docs/cluster.md and the script for Slurm, run as they stand there.

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::launched::said;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Lines of the blocks of commands that begin with a word.
fn commands(word: &str) -> Vec<String> {
    let page = std::fs::read_to_string(root().join("docs/cluster.md")).expect("the page");
    let blocks = page.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next().map(str::to_owned));
    let lines = blocks.flat_map(|block| block.lines().map(str::to_owned).collect::<Vec<_>>());
    lines.filter(|line| line.split(' ').next() == Some(word)).collect()
}

/// A folder with the recipe of the page, the script for Slurm, and a folder `bin` for programs.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = "[landscape]\nsize = 64\ncell = 10.0\nseed = 3\n[[step]]\ndo = \"diamond-square\"\nrelief = 90\n\
                  [[step]]\ndo = \"hydraulic\"\niterations = 60\n[[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n";
    std::fs::write(folder.path().join("valley.toml"), recipe).expect("written");
    let large = "[landscape]\nsize = 200\ncell = 10.0\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"hydraulic\"\nmodel = \"han\"\n\
                 iterations = 20\n[[step]]\ndo = \"flow\"\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";
    std::fs::write(folder.path().join("large.toml"), large).expect("written");
    let script = root().join("crates/weald-mpi/examples/weald.sbatch");
    std::fs::copy(script, folder.path().join("weald.sbatch")).expect("copied");
    std::fs::create_dir(folder.path().join("bin")).expect("made");
    folder
}

/// Writes a program of the shell into `bin`.
fn program(folder: &Path, name: &str, text: &str) {
    let path = folder.join("bin").join(name);
    std::fs::write(&path, format!("#!/bin/bash\n{text}\n")).expect("written");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("made a program");
}

/// Runs a line of the shell in a folder, where `weald-mpi` and the programs of `bin` are found; more ranks than cores are
/// well, as is the root of a container.
fn shell(folder: &Path, line: &str) -> Output {
    let ours = Path::new(env!("CARGO_BIN_EXE_weald-mpi")).parent().expect("a folder").to_owned();
    let path = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{}:{path}", folder.join("bin").display(), ours.display());
    Command::new("bash")
        .args(["-c", line])
        .current_dir(folder)
        .env("PATH", path)
        .envs([
            ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
            ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
            ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
            ("OMPI_MCA_mpi_yield_when_idle", "1"),
        ])
        .output()
        .expect("there is a shell")
}

#[test]
fn every_command_of_the_page_that_starts_ranks_does_what_it_says() {
    let folder = folder();
    let lines = commands("mpirun");
    assert!(lines.len() >= 6, "{lines:?}");
    for line in lines {
        let output = shell(folder.path(), &line);
        assert!(output.status.success(), "{line}\n{}", said(&output));
    }
    assert!(folder.path().join("out/valley/height.npy").exists());
    assert!(folder.path().join("out/larger/report.json").exists());
    assert!(folder.path().join("out/large/height.tif").exists());
}

#[test]
fn the_script_for_slurm_starts_goes_on_and_is_queued_again() {
    let folder = folder();
    // What Slurm would do: ranks side by side, and a queue.
    program(
        folder.path(),
        "srun",
        "while [[ $1 == --* ]]; do shift; done\necho \"$*\" >> asked\n\
         [[ -e interrupt ]] && { rm interrupt; exit 130; }\nexec mpirun -n 4 \"$@\"",
    );
    program(folder.path(), "scontrol", "echo \"$*\" >> asked");
    let job = "SLURM_JOB_ID=77 SLURM_CPUS_PER_TASK=1 bash weald.sbatch valley.toml";
    let asked = || std::fs::read_to_string(folder.path().join("asked")).unwrap_or_default();
    std::fs::write(folder.path().join("interrupt"), "").expect("written");
    let output = shell(folder.path(), job);
    assert!(output.status.success() && asked().ends_with("requeue 77\n"), "{}\n{}", asked(), said(&output));
    assert!(!asked().contains("--resume"));
    let output = shell(folder.path(), job);
    assert!(
        output.status.success() && folder.path().join("out/valley/height.npy").exists(),
        "{}",
        said(&output)
    );
    std::fs::write(folder.path().join("out/valley/checkpoint.weald"), "damaged").expect("written");
    let output = shell(folder.path(), job);
    assert!(asked().ends_with("--resume\n"), "{}", asked());
    assert_eq!(output.status.code(), Some(4), "what is wrong ends the job: {}", said(&output));
    let output = shell(folder.path(), "SLURM_JOB_ID=77 SLURM_CPUS_PER_TASK=1 bash weald.sbatch none.toml");
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
}

#[test]
fn the_page_names_a_script_that_asks_for_what_it_says() {
    let script =
        std::fs::read_to_string(root().join("crates/weald-mpi/examples/weald.sbatch")).expect("there");
    for said in ["--nodes=4", "--ntasks-per-node=1", "--signal=TERM@120", "scontrol requeue"] {
        assert!(script.contains(said), "{said}");
    }
    assert_eq!(commands("sbatch"), ["sbatch weald.sbatch valley.toml"]);
}
