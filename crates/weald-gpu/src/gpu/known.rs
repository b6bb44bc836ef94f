//! What was compiled for pictures, kept with the device: the next renderer has the same pipelines at once.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use wgpu::{ComputePipeline, Device, RenderPipeline, ShaderModule, ShaderModuleDescriptor, ShaderSource};

/// A module, and what tells its pipelines from each other: entry point, samples, format, constants.
type Key = (ShaderModule, String);

/// Modules by their text, and their pipelines.
#[derive(Debug, Default)]
pub(crate) struct Known {
    modules: Mutex<HashMap<String, ShaderModule>>,
    drawing: Mutex<HashMap<Key, RenderPipeline>>,
    computing: Mutex<HashMap<Key, ComputePipeline>>,
}

impl Known {
    /// The module of a text.
    pub(crate) fn module(&self, device: &Device, label: &str, text: String) -> ShaderModule {
        get_or_make(&self.modules, text, |text| {
            let source = ShaderSource::Wgsl(text.as_str().into());
            device.create_shader_module(ShaderModuleDescriptor { label: Some(label), source })
        })
    }

    /// The pipeline that draws by a module.
    pub(crate) fn drawing(&self, key: Key, make: impl FnOnce() -> RenderPipeline) -> RenderPipeline {
        get_or_make(&self.drawing, key, |_| make())
    }

    /// The pipeline that computes by a module.
    pub(crate) fn computing(&self, key: Key, make: impl FnOnce() -> ComputePipeline) -> ComputePipeline {
        get_or_make(&self.computing, key, |_| make())
    }

    /// Forgets all of them.
    pub(super) fn clear(&self) {
        clear(&self.drawing);
        clear(&self.computing);
        clear(&self.modules);
    }
}

/// What is made is made without the lock: others are compiled meanwhile. Of two that were made of one key the first is kept.
fn get_or_make<K, V>(known: &Mutex<HashMap<K, V>>, key: K, make: impl FnOnce(&K) -> V) -> V
where
    K: Eq + std::hash::Hash,
    V: Clone,
{
    let lock = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let there = lock().get(&key).cloned();
    there.unwrap_or_else(|| {
        let value = make(&key);
        lock().entry(key).or_insert(value).clone()
    })
}

fn clear<K, V>(known: &Mutex<HashMap<K, V>>) {
    known.lock().unwrap_or_else(PoisonError::into_inner).clear();
}
