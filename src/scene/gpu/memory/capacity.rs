//! The part of a device on which the layout of a scene depends.

use super::folded;
use crate::scene::description::SceneError;
use crate::scene::gpu::tree::LARGEST_FIRST;
use wgpu::{Device, DeviceType, Limits};

/// A device as plain data, so that a scene can be laid out without one.
#[derive(Clone, Debug)]
pub(crate) struct Capacity {
    pub limits: Limits,
    /// True if the adapter is the CPU.
    pub on_cpu: bool,
}

impl Capacity {
    pub fn of(device: &Device) -> Self {
        Self { limits: device.limits(), on_cpu: device.adapter_info().device_type == DeviceType::Cpu }
    }

    /// Bytes that a shader can read from one buffer.
    pub fn largest_buffer(&self) -> u64 {
        self.limits.max_storage_buffer_binding_size.min(self.limits.max_buffer_size)
    }

    /// Checks the number of texels of a folded texture. The height of a texture limits its rows, and references can address 2²⁷
    /// triangles.
    pub fn check_texels(&self, element: &str, texels: usize) -> Result<(), SceneError> {
        let most = folded::WIDTH * self.limits.max_texture_dimension_2d as usize;
        if texels <= most && texels / 3 < LARGEST_FIRST as usize {
            return Ok(());
        }
        let reason = format!(
            "take {texels} texels, a folded texture of the device has {most}: use fewer, or raise max_texture_dimension_2d"
        );
        Err(SceneError::of_scene(element, reason))
    }

    /// Checks the size of a storage buffer.
    pub fn check_bytes(&self, element: &str, bytes: usize) -> Result<(), SceneError> {
        let limit = self.largest_buffer();
        if bytes as u64 <= limit {
            return Ok(());
        }
        let reason = format!(
            "take {bytes} bytes, the device's max_storage_buffer_binding_size is {limit}: raise it, or use fewer triangles"
        );
        Err(SceneError::of_scene(element, reason))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn geometry_that_is_too_large_is_named_with_a_remedy() {
        let capacity = Capacity { limits: Limits::default(), on_cpu: false };
        assert!(capacity.check_texels("triangles", 4096 * 8192).is_ok());
        let error = capacity.check_texels("triangles", 4096 * 8192 + 1).unwrap_err();
        for part in ["take 33554433 texels", "has 33554432", "max_texture_dimension_2d"] {
            assert!(error.reason.contains(part), "{part}: {error}");
        }
        assert!(capacity.check_bytes("normals", 128 << 20).is_ok());
        let error = capacity.check_bytes("normals", (128 << 20) + 1).unwrap_err();
        for part in ["take 134217729 bytes", "max_storage_buffer_binding_size is 134217728"] {
            assert!(error.reason.contains(part), "{part}: {error}");
        }
    }
}
