//! Programs that open our files, installed by `clients/install`.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// The folder of the project.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A file of a client, which must be installed.
pub(crate) fn client(file: &str) -> PathBuf {
    let folder =
        std::env::var_os("WEALD_CLIENTS").map_or_else(|| root().join("target/clients"), PathBuf::from);
    let path = folder.join(file);
    assert!(path.exists(), "{} is missing; install it: clients/install", path.display());
    path
}

/// What a program prints in its last line, as JSON.
pub(crate) fn said(command: &mut Command) -> Value {
    let output = command.output().unwrap_or_else(|cause| panic!("{command:?} does not start: {cause}"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {message}");
    let text = String::from_utf8_lossy(&output.stdout);
    let last = text.trim_end().lines().next_back().unwrap_or_default();
    serde_json::from_str(last)
        .unwrap_or_else(|cause| panic!("{command:?} says no JSON ({cause}): {text}{message}"))
}

/// What the Khronos validator says of a `.glb`.
pub(crate) fn validated(path: &Path) -> Value {
    let script = root().join("clients/validate_glb.cjs");
    said(Command::new("node").arg(script).arg(path).env("NODE_PATH", client("gltf/node_modules")))
}
