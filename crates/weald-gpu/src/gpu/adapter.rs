//! Which adapter runs programs.

use std::path::Path;

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::{Adapter, Backend, Backends, DeviceType, Instance, InstanceDescriptor, InstanceFlags};

/// Interfaces with compute passes. OpenGL is left out: to look for it is slow and noisy without a display.
const BACKENDS: Backends = Backends::PRIMARY;

/// Share of the memory that the driver grants, in percent, beyond which it refuses instead of risking to lose
/// the device.
const FULL_PERCENT: u8 = 95;

/// What a user may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// A graphics card.
    Hardware,
    /// A graphics card, else anything that computes.
    Any,
    /// A driver that computes on the CPU.
    Software,
}

impl Wanted {
    fn admits(self, kind: DeviceType) -> bool {
        match self {
            Self::Hardware => matches!(kind, DeviceType::DiscreteGpu | DeviceType::IntegratedGpu),
            Self::Any => true,
            Self::Software => kind == DeviceType::Cpu,
        }
    }
}

/// Device files of graphics cards on Linux: the kernel's interface, NVIDIA's, that of Windows below, phones'.
const CARDS: [&str; 5] = ["/dev/dri", "/dev/nvidiactl", "/dev/dxg", "/dev/mali0", "/dev/kgsl-3d0"];

/// Whether a look for graphics cards is worth its time. Where there is none, drivers still take a fifth of a
/// second to say so, and some complain on stderr that there is no display.
pub(crate) fn may_have_a_card() -> bool {
    !cfg!(target_os = "linux") || CARDS.iter().any(|file| Path::new(file).exists())
}

/// All adapters of this machine.
pub(crate) fn all() -> Vec<Adapter> {
    pollster::block_on(offered())
}

/// All adapters of this machine, or the one that a browser offers.
pub(crate) async fn offered() -> Vec<Adapter> {
    let mut description = InstanceDescriptor::new_without_display_handle();
    description.backends = BACKENDS;
    description.flags = InstanceFlags::empty();
    description.memory_budget_thresholds.for_resource_creation = Some(FULL_PERCENT);
    Instance::new(description).enumerate_adapters(BACKENDS).await
}

/// The best of these adapters that is wanted: cards of their own first.
pub(crate) fn best(adapters: Vec<Adapter>, wanted: Wanted) -> Option<Adapter> {
    let admitted = adapters.into_iter().filter(|adapter| wanted.admits(adapter.get_info().device_type));
    admitted.min_by_key(|adapter| {
        let info = adapter.get_info();
        (rank_of_kind(info.device_type), rank_of_backend(info.backend))
    })
}

fn rank_of_kind(kind: DeviceType) -> u8 {
    match kind {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

/// Where one card answers to two interfaces, Vulkan does what is asked with the least in between.
fn rank_of_backend(backend: Backend) -> u8 {
    u8::from(backend != Backend::Vulkan)
}

/// Name, interface and driver.
pub(crate) fn describe(adapter: &Adapter) -> String {
    let info = adapter.get_info();
    let driver = [info.driver.as_str(), info.driver_info.as_str()].join(" ");
    format!("{} ({}, {})", info.name, info.backend, driver.trim())
}

/// No adapter is as wanted: what was found, and what to do.
pub(crate) fn none(found: Vec<String>, wanted: Wanted) -> Error {
    let kind = match wanted {
        Wanted::Hardware => "graphics card",
        Wanted::Any => "adapter",
        Wanted::Software => "software adapter",
    };
    let listed = if found.is_empty() { "none at all".to_owned() } else { found.join(", ") };
    let message = format!(
        "no {kind} with Vulkan, Metal or Direct3D 12; found: {listed}; install the driver of the graphics card, or \
         a software one (Debian, Ubuntu: mesa-vulkan-drivers), or use --engine cpu"
    );
    DeviceError::new(DeviceErrorKind::NoAdapter { found }, message).into()
}

/// A browser offers none.
pub(crate) fn none_in_a_browser() -> Error {
    let kind = DeviceErrorKind::NoAdapter { found: Vec::new() };
    DeviceError::new(kind, "the browser gives no graphics device to its workers").into()
}

/// Nothing draws: what to do.
pub(crate) fn none_that_draws() -> Error {
    let message = "there is no graphics device with Vulkan, Metal or Direct3D 12 to draw on; install the driver of the \
                   graphics card, or a software one (Debian, Ubuntu: mesa-vulkan-drivers), or draw on the processor by \
                   --fallback view";
    DeviceError::new(DeviceErrorKind::NoAdapter { found: Vec::new() }, message).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn software_is_never_taken_for_a_graphics_card() {
        assert!(Wanted::Hardware.admits(DeviceType::DiscreteGpu));
        assert!(Wanted::Hardware.admits(DeviceType::IntegratedGpu));
        for kind in [DeviceType::Cpu, DeviceType::VirtualGpu, DeviceType::Other] {
            assert!(!Wanted::Hardware.admits(kind), "{kind:?}");
            assert!(Wanted::Any.admits(kind), "{kind:?}");
        }
    }

    #[test]
    fn the_error_names_what_was_found_and_what_to_do() {
        let adapter = "llvmpipe (vulkan, llvmpipe Mesa)".to_owned();
        let error = none(vec![adapter.clone()], Wanted::Hardware);
        let text = error.to_string();
        for part in ["graphics card", "llvmpipe", "mesa-vulkan-drivers", "--engine cpu"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let Error::Device(DeviceError { kind: DeviceErrorKind::NoAdapter { found }, .. }) = error else {
            panic!("{text}")
        };
        assert_eq!(found, [adapter]);
        assert!(none(Vec::new(), Wanted::Any).to_string().contains("none at all"));
    }
}
