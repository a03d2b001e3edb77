//! Compiled shaders, which denoisers of one device can share.

use super::compose::{Permutation, Shaders};
use super::kernel::Kernel;
use crate::Error;
use crate::passes::{Step, Traversal};
use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wgpu::Device;

/// The compiled shaders of a device. A clone is another handle to the same shaders: hand it to further denoisers
/// ([`DenoiserDescriptor::pipelines`](crate::DenoiserDescriptor::pipelines)), so that each shader is compiled once. While a shader
/// is being compiled, only callers that need it wait.
#[derive(Clone)]
pub struct Pipelines {
    device: Device,
    shared: Arc<Shared>,
}

/// A shader that is compiled, or is being compiled by the holder of the lock.
type Slot = Arc<Mutex<Option<Arc<Kernel>>>>;

/// Locks are taken in this order: a slot's, then either of these. Each of these is held only to look something up or to compose a
/// source. A driver compiles, for seconds, under the slot's lock alone.
struct Shared {
    composer: Mutex<Shaders>,
    slots: Mutex<HashMap<Permutation, Slot>>,
}

impl Pipelines {
    /// An empty cache.
    pub(crate) fn new(device: &Device) -> Result<Self, Error> {
        let shared = Shared { composer: Mutex::new(Shaders::new()?), slots: Mutex::default() };
        Ok(Self { device: device.clone(), shared: Arc::new(shared) })
    }

    /// True if the shaders are this device's. wgpu numbers devices by instance, and cannot tell devices of two instances apart.
    pub(crate) fn belong_to(&self, device: &Device) -> bool {
        self.device == *device
    }

    /// The compiled shader of a step. Compiles it if necessary.
    pub(crate) fn kernel(&self, step: &Step, traversal: Traversal) -> Result<Arc<Kernel>, Error> {
        let permutation = Permutation::of(step, traversal);
        let slot = self.slot(permutation);
        let mut slot = lock(&slot);
        if let Some(kernel) = &*slot {
            return Ok(kernel.clone());
        }
        let module = lock(&self.shared.composer).compose(permutation)?;
        let kernel = Arc::new(Kernel::new(&self.device, module, step)?);
        Ok(slot.insert(kernel).clone())
    }

    fn slot(&self, permutation: Permutation) -> Slot {
        lock(&self.shared.slots).entry(permutation).or_default().clone()
    }

    /// The number of compiled shaders, without those that are being compiled.
    pub fn count(&self) -> usize {
        let slots: Vec<Slot> = lock(&self.shared.slots).values().cloned().collect();
        slots.iter().filter(|slot| slot.try_lock().is_ok_and(|slot| slot.is_some())).count()
    }
}

/// Locks a mutex, even after a panic of another thread, because nothing is left half done: a kernel is in its slot or not.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl fmt::Debug for Pipelines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pipelines").field("count", &self.count()).finish()
    }
}

#[cfg(all(test, feature = "path-tracer"))]
mod tests {
    use super::*;
    use crate::passes::{Feature, Features, variance};
    use crate::twins::gpu::gpu;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn whoever_has_what_it_needs_does_not_wait_for_others_to_compile() {
        let pipelines = Pipelines::new(&gpu().device).unwrap();
        let of = |features: &[Feature]| Step::new(&variance::PASS, Features::of(features));
        let (ready, busy) = (of(&[]), of(&[Feature::VarianceOfMean]));
        let kernel = |pipelines: &Pipelines, step: &Step| pipelines.kernel(step, Traversal::default()).map(|_| ());
        kernel(&pipelines, &ready).unwrap();
        // While the slot's lock is held, the second shader counts as being compiled.
        let slot = pipelines.slot(Permutation::of(&busy, Traversal::default()));
        let compiling = lock(&slot);
        let (sender, receiver) = mpsc::channel();
        let others = pipelines.clone();
        std::thread::spawn(move || {
            let kernel = kernel(&others, &ready);
            sender.send((kernel.is_ok(), others.count())).unwrap();
        });
        let found = receiver.recv_timeout(Duration::from_secs(60)).expect("the other denoiser does not wait");
        assert_eq!(found, (true, 1));
        drop(compiling);
        kernel(&pipelines, &busy).unwrap();
        assert_eq!(pipelines.count(), 2);
    }
}
