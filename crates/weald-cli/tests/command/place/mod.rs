//! A folder to run the command in.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its own part")]

use std::path::PathBuf;
use std::process::{Command, Output};

use tempfile::TempDir;

/// A folder with a recipe in it, in which the command runs.
pub struct Place {
    folder: TempDir,
}

impl Place {
    pub fn with(recipe: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("r.toml"), recipe).expect("the recipe is written");
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_weald"));
        // What one test keeps another does not find, and most are about what a run does.
        command.current_dir(self.folder.path()).env("WEALD_CACHE", "off").args(arguments);
        command
    }

    pub fn weald(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the command starts")
    }

    /// Runs and gives exit code and stderr.
    pub fn ends(&self, arguments: &[&str]) -> (i32, String) {
        let output = self.weald(arguments);
        (
            output.status.code().expect("it ends by itself"),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    }

    pub fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(folder)).expect("the folder exists");
        let name = |entry: std::fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<_> = entries.map(|entry| name(entry.expect("readable"))).collect();
        names.sort();
        names
    }
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub fn assert_ends(place: &Place, arguments: &[&str], code: i32, parts: &[&str]) {
    let (found, message) = place.ends(arguments);
    assert_eq!(found, code, "{arguments:?}: {message}");
    for part in parts {
        assert!(message.contains(part), "{arguments:?}: {part:?} is in: {message}");
    }
}

/// Whether a developer without any adapter leaves a test out that needs one.
pub fn left_out() -> bool {
    let left_out = std::env::var_os("WEALD_NO_GPU").is_some_and(|value| value == "1");
    if left_out {
        println!("WEALD_NO_GPU=1 is set: this test of a device is left out");
    }
    left_out
}
