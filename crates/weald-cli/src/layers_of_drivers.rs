//! A layer of Mesa asks the desktop which graphics card it likes. Without a desktop it prints an error in every process that
//! looks for a device, though nothing is wrong: Weald chooses by itself.

/// Starts this command anew with that layer left out, where there is no desktop; it goes on where that is not possible. A
/// process cannot change its own environment without `unsafe`.
#[cfg(target_os = "linux")]
pub(crate) fn silence() {
    use std::os::unix::process::CommandExt;
    use std::process::Command;

    /// Variables by which the layer has a desktop, is left out, or is asked for something.
    const SAID: [&str; 3] = ["XDG_RUNTIME_DIR", "NODEVICE_SELECT", "MESA_VK_DEVICE_SELECT"];
    if SAID.iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty())) {
        return;
    }
    let mut arguments = std::env::args_os();
    let Some((itself, name)) = std::env::current_exe().ok().zip(arguments.next()) else { return };
    // It only comes back where it failed, and then the line is printed as before.
    let _ = Command::new(itself).arg0(name).args(arguments).env("NODEVICE_SELECT", "1").exec();
}

/// Other systems have no such layer.
#[cfg(not(target_os = "linux"))]
pub(crate) fn silence() {}
