//! The parts of an opened file.

use std::collections::HashMap;

use gltf::json::{Index, Root, buffer::View};

use super::buffer::Buffer;
use super::pointer::PointerChannel;
use crate::scene::load::common::folder::Folder;
use crate::scene::load::common::report::Fault;

/// The index in [`Scene::nodes`](crate::scene::description::Scene::nodes) of each node of the file that is in the scene.
pub(super) type Places = HashMap<usize, usize>;

/// An opened file: its JSON, its bytes and its folder.
pub(super) struct Source<'a> {
    pub root: Root,
    /// Animation channels that are not those of nodes.
    pub pointers: Vec<PointerChannel>,
    pub buffers: Vec<Buffer>,
    pub folder: Folder<'a>,
}

impl Source<'_> {
    /// The element at an index. `user` is the element that holds the index.
    pub fn get<T>(&self, index: Index<T>, user: &str) -> Result<&T, Fault>
    where
        Root: AsRef<[T]>,
    {
        lookup(self.root.as_ref(), index, user)
    }

    /// The bytes of a buffer view.
    pub fn view(&self, index: Index<View>, user: &str) -> Result<(&View, &[u8]), Fault> {
        let view = self.get(index, user)?;
        let fault = |reason| Fault::new(format!("bufferViews[{index}]"), reason);
        let buffer = self.buffers.get(view.buffer.value()).ok_or_else(|| {
            fault(format!("buffer {} is out of range: the file has {}", view.buffer, self.buffers.len()))
        })?;
        let extensions = view.extensions.as_ref().map(|extensions| &extensions.others);
        if extensions.is_some_and(|others| {
            others.contains_key("EXT_meshopt_compression") || others.contains_key("KHR_meshopt_compression")
        }) {
            return Err(fault("is compressed with meshopt, which is not supported".into()));
        }
        let buffer = buffer.as_ref().map_err(Fault::clone)?;
        let (start, length) = (view.byte_offset.map_or(0, |offset| offset.0), view.byte_length.0);
        // Some writers round the length up past the end of the buffer. The users of the view find out if bytes are missing.
        let end = start.saturating_add(length).min(buffer.len() as u64);
        let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
        let bytes = range.and_then(|(start, end)| buffer.get(start..end)).ok_or_else(|| {
            fault(format!("{length} bytes from {start} on are not within its buffer of {} bytes", buffer.len()))
        })?;
        Ok((view, bytes))
    }
}

/// The element at an index into a list. `user` is the element that holds the index.
pub(super) fn lookup<'a, T>(items: &'a [T], index: Index<T>, user: &str) -> Result<&'a T, Fault> {
    items
        .get(index.value())
        .ok_or_else(|| Fault::new(user, format!("index {index} is out of range: the file has {}", items.len())))
}
