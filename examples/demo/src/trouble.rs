//! Errors that the device reports by callback, because no call returns them.

use std::sync::{Arc, Mutex};
use wgpu::Device;

/// Messages of a device, and the fact of its loss.
#[derive(Clone, Default)]
pub struct Trouble(Arc<Mutex<Reports>>);

#[derive(Default)]
struct Reports {
    untold: Vec<String>,
    lost: bool,
}

impl Trouble {
    /// Listens to a device. Without this, wgpu ends the program at the first error.
    pub fn of(device: &Device) -> Self {
        let trouble = Self::default();
        let (errors, loss) = (trouble.clone(), trouble.clone());
        device.on_uncaptured_error(Arc::new(move |error| errors.tell(format!("the GPU failed: {error}"), false)));
        device.set_device_lost_callback(move |reason, message| {
            let text =
                format!("the GPU was lost ({reason:?}): {message} Start the demo again; saved files can be loaded.");
            loss.tell(text, true);
        });
        trouble
    }

    /// Returns true if the device is lost and can draw nothing more.
    pub fn is_lost(&self) -> bool {
        self.0.lock().is_ok_and(|reports| reports.lost)
    }

    /// Takes the messages that have not been shown yet.
    pub fn take(&self) -> Vec<String> {
        self.0.lock().map(|mut reports| std::mem::take(&mut reports.untold)).unwrap_or_default()
    }

    fn tell(&self, text: String, lost: bool) {
        let Ok(mut reports) = self.0.lock() else { return };
        reports.lost |= lost;
        reports.untold.push(text);
    }
}
