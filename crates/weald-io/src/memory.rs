//! Whether there is memory for what is about to be made. Rust ends a process that asks for more than there is, so that this must be
//! found out before.

#[cfg(target_os = "linux")]
use weald_core::files;

/// Whether the address space, which may be limited below the memory there is, has room for blocks of so many bytes at once.
/// It takes no memory.
pub fn has_addresses(blocks: &[u64]) -> bool {
    let mut probes: Vec<Vec<u8>> = vec![Vec::new(); blocks.len()];
    let mut wanted = probes.iter_mut().zip(blocks);
    wanted.all(|(probe, size)| usize::try_from(*size).is_ok_and(|size| probe.try_reserve_exact(size).is_ok()))
}

/// Memory that is free or can be freed, in bytes, where the system tells it.
#[cfg(target_os = "linux")]
pub fn available() -> Option<u64> {
    let number = |path: &str| files::read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let text = files::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let free = line.trim().trim_end_matches(" kB").parse::<u64>().ok()? << 10;
    // A container has less than the machine.
    let most = number("/sys/fs/cgroup/memory.max").zip(number("/sys/fs/cgroup/memory.current"));
    let left = most.map(|(most, used)| most.saturating_sub(used));
    Some(left.map_or(free, |left| left.min(free)))
}

/// Memory that is free or can be freed, in bytes, where the system tells it.
#[cfg(not(target_os = "linux"))]
pub fn available() -> Option<u64> {
    None
}
