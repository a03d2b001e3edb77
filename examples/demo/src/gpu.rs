//! The device that eframe makes for the demo.

use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::sync::Arc;
use wgpu::{Backends, DeviceDescriptor, Features, Limits};

/// Asks for no more than every WebGPU device has and, if the adapter offers them, for timestamps and room for large scenes.
pub fn configuration() -> WgpuConfiguration {
    WgpuConfiguration { wgpu_setup: setup(), ..Default::default() }
}

/// Instructs eframe how to choose the adapter and make the device.
pub fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    // OpenGL lacks some of the storage texture formats; WGPU_BACKEND may still select it.
    setup.instance_descriptor.backends = Backends::from_env().unwrap_or(Backends::PRIMARY);
    setup.device_descriptor = Arc::new(|adapter| DeviceDescriptor {
        label: Some("demo"),
        required_features: adapter.features() & Features::TIMESTAMP_QUERY,
        required_limits: Limits {
            max_buffer_size: adapter.limits().max_buffer_size,
            max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
            ..Limits::default()
        },
        ..Default::default()
    });
    WgpuSetup::CreateNew(setup)
}
