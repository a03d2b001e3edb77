//! Compiled shaders, which denoisers of one device can share.

use super::compose::{Permutation, Shaders};
use super::kernel::Kernel;
use crate::Error;
use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wgpu::Device;

/// The compiled shaders of a device. A clone is another handle to the same: hand it to further denoisers
/// ([`DenoiserDescriptor::pipelines`](crate::DenoiserDescriptor::pipelines)), and each shader is compiled once.
#[derive(Clone)]
pub struct Pipelines {
    device: Device,
    cache: Arc<Mutex<Cache>>,
}

struct Cache {
    shaders: Shaders,
    kernels: HashMap<Permutation, Arc<Kernel>>,
}

impl Pipelines {
    /// None compiled yet.
    pub(crate) fn new(device: &Device) -> Result<Self, Error> {
        let cache = Cache { shaders: Shaders::new()?, kernels: HashMap::new() };
        Ok(Self { device: device.clone(), cache: Arc::new(Mutex::new(cache)) })
    }

    /// Whether they are this device's. wgpu numbers devices by instance, and cannot tell those of two instances apart.
    pub(crate) fn belong_to(&self, device: &Device) -> bool {
        self.device == *device
    }

    /// The compiled shader; compiles it if that was not done.
    pub(crate) fn kernel(&self, permutation: Permutation) -> Result<Arc<Kernel>, Error> {
        let mut cache = self.lock();
        if let Some(kernel) = cache.kernels.get(&permutation) {
            return Ok(kernel.clone());
        }
        let kernel = Arc::new(Kernel::new(&self.device, &mut cache.shaders, permutation)?);
        cache.kernels.insert(permutation, kernel.clone());
        Ok(kernel)
    }

    /// How many are compiled.
    pub fn count(&self) -> usize {
        self.lock().kernels.len()
    }

    /// Nothing is half done when a thread panics here: a kernel is in the map or not.
    fn lock(&self) -> MutexGuard<'_, Cache> {
        self.cache.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Pipelines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pipelines").field("count", &self.count()).finish()
    }
}
