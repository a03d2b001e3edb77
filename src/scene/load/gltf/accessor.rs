//! Accessors: typed views of buffers. Elements are decoded one by one on demand, so that a file that announces more than it holds
//! cannot cause a large allocation.

use gltf::json::accessor::{Accessor, ComponentType, Type, sparse};
use gltf::json::validation::Checked;
use gltf::json::{Index, buffer};

use super::source::Source;
use crate::scene::load::common::report::Fault;

/// Maximum number of elements of an accessor without data of its own, which costs a file nothing.
const MAX_ZEROS: u64 = 1 << 24;

/// The component types of indices.
pub(super) const INDEX: &[ComponentType] = &[ComponentType::U8, ComponentType::U16, ComponentType::U32];

/// The component types of vertex attributes and of animated values, with KHR_mesh_quantization.
pub(super) const REAL: &[ComponentType] =
    &[ComponentType::F32, ComponentType::I8, ComponentType::U8, ComponentType::I16, ComponentType::U16];

/// The elements of an accessor. Their place in the file has been checked.
pub(super) struct Elements<'a> {
    shape: Type,
    count: usize,
    component: ComponentType,
    normalized: bool,
    /// All elements. `None` stands for zeros.
    dense: Option<Strided<'a>>,
    /// Elements that replace those of `base`, by increasing index, each with its place among the values.
    sparse: Option<(Vec<(u32, usize)>, Strided<'a>)>,
}

impl<'a> Elements<'a> {
    /// Opens an accessor that must hold elements of `shape` made of one of `components`. Errors are attributed to `user`, the element that
    /// refers to it.
    pub fn open(
        source: &'a Source<'a>,
        index: Index<Accessor>,
        shape: Type,
        components: &[ComponentType],
        user: &str,
    ) -> Result<Self, Fault> {
        let accessor = source.get(index, user)?;
        let fault = |reason: String| Fault::new(user, format!("accessor {index}: {reason}"));
        if accessor.type_ != Checked::Valid(shape) {
            return Err(fault(format!("its type is not {}", shape_name(shape))));
        }
        let component = match accessor.component_type {
            Checked::Valid(component) if components.contains(&component.0) => component.0,
            Checked::Valid(component) => {
                return Err(fault(format!(
                    "its component type is {}, where one of {} belongs",
                    component_name(component.0),
                    components.iter().map(|&component| component_name(component)).collect::<Vec<_>>().join(", "),
                )));
            }
            Checked::Invalid => return Err(fault("its component type does not exist".into())),
        };
        let size = component.size() * shape.multiplicity();
        let count = accessor.count.0;
        let dense = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                Some(Strided::open(source, view, offset, count, size, user).map_err(|reason| reason.within(&fault))?)
            }
            None if count > MAX_ZEROS => {
                return Err(fault(format!("{count} elements without a buffer view; at most {MAX_ZEROS} are read")));
            }
            None => None,
        };
        let sparse = match &accessor.sparse {
            Some(sparse) => {
                Some(open_sparse(source, sparse, count, size, user).map_err(|reason| reason.within(&fault))?)
            }
            None => None,
        };
        // Both cases above bound the count, by the size of the file or by a constant.
        let count = usize::try_from(count).map_err(|_| fault(format!("{count} elements are too many")))?;
        Ok(Self { shape, count, component, normalized: accessor.normalized, dense, sparse })
    }

    /// True if the elements have this shape.
    pub fn has_shape(&self, shape: Type) -> bool {
        self.shape == shape
    }

    /// True if integers stand for themselves, false if they stand for 0…1 or −1…1.
    pub fn is_whole(&self) -> bool {
        !self.normalized && self.component != ComponentType::F32
    }

    /// An element as numbers, with integers normalised whatever the file says.
    pub fn normalized<const N: usize>(&self, index: usize) -> [f32; N] {
        self.numbers(index, true)
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.count
    }

    /// An element as numbers; normalised integers become 0…1 or −1…1. Zeros past the end.
    pub fn vector<const N: usize>(&self, index: usize) -> [f32; N] {
        self.numbers(index, self.normalized)
    }

    fn numbers<const N: usize>(&self, index: usize, normalized: bool) -> [f32; N] {
        let mut vector = [0.0; N];
        if let Some(bytes) = self.bytes(index) {
            for (number, bytes) in vector.iter_mut().zip(bytes.chunks_exact(self.component.size())) {
                *number = real(bytes, self.component, normalized);
            }
        }
        vector
    }

    /// `N` unsigned integers. Zeros past the end.
    pub fn integers<const N: usize>(&self, index: usize) -> [u32; N] {
        let mut integers = [0; N];
        if let Some(bytes) = self.bytes(index) {
            for (integer, bytes) in integers.iter_mut().zip(bytes.chunks_exact(self.component.size())) {
                *integer = unsigned(bytes);
            }
        }
        integers
    }

    /// A single unsigned integer. Zero past the end.
    pub fn integer(&self, index: usize) -> u32 {
        self.bytes(index).map_or(0, unsigned)
    }

    fn bytes(&self, index: usize) -> Option<&'a [u8]> {
        if let Some((replaced, values)) = &self.sparse
            && let Ok(index) = u32::try_from(index)
            && let Ok(found) = replaced.binary_search_by_key(&index, |&(replaced, _)| replaced)
        {
            return values.get(replaced.get(found)?.1);
        }
        self.dense.as_ref()?.get(index)
    }
}

/// Elements at equal distances.
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

/// An error in opening elements: a fault of the buffer view, or a reason to attribute to the accessor.
enum Unopened {
    View(Fault),
    Reason(String),
}

impl Unopened {
    fn within(self, fault: &impl Fn(String) -> Fault) -> Fault {
        match self {
            Self::View(fault) => fault,
            Self::Reason(reason) => fault(reason),
        }
    }
}

impl<'a> Strided<'a> {
    fn open(
        source: &'a Source<'a>,
        view: Index<buffer::View>,
        offset: u64,
        count: u64,
        size: usize,
        user: &str,
    ) -> Result<Self, Unopened> {
        let (description, bytes) = source.view(view, user).map_err(Unopened::View)?;
        // A stride of 0 means no gaps, as in OpenGL.
        let stride = description.byte_stride.map_or(size, |stride| stride.0);
        let stride = if stride == 0 { size } else { stride };
        if stride < size {
            return Err(Unopened::Reason(format!("elements of {size} bytes do not fit a stride of {stride}")));
        }
        // The last element need not fill its stride.
        let past_end = || {
            Unopened::Reason(format!(
                "{count} elements of {size} bytes from byte {offset} on do not fit the {} bytes of buffer view {view}",
                bytes.len()
            ))
        };
        let length = match count.checked_sub(1) {
            None => Some(0),
            Some(last) => last.checked_mul(stride as u64).and_then(|last| last.checked_add(size as u64)),
        };
        let start = usize::try_from(offset).map_err(|_| past_end())?;
        let end = length.and_then(|length| length.checked_add(offset)).and_then(|end| usize::try_from(end).ok());
        let bytes = end.and_then(|end| bytes.get(start..end)).ok_or_else(past_end)?;
        Ok(Self { bytes, stride, size })
    }

    fn get(&self, index: usize) -> Option<&'a [u8]> {
        let start = index.checked_mul(self.stride)?;
        self.bytes.get(start..start.checked_add(self.size)?)
    }
}

fn open_sparse<'a>(
    source: &'a Source<'a>,
    sparse: &sparse::Sparse,
    count: u64,
    size: usize,
    user: &str,
) -> Result<(Vec<(u32, usize)>, Strided<'a>), Unopened> {
    let reason = |reason: String| Unopened::Reason(format!("sparse: {reason}"));
    let replaced = sparse.count.0;
    if replaced > count {
        return Err(reason(format!("{replaced} replacements for {count} elements")));
    }
    let Checked::Valid(component) = sparse.indices.component_type else {
        return Err(reason("the component type of its indices is not an unsigned integer".into()));
    };
    let (indices, values) = (&sparse.indices, &sparse.values);
    let index_size = component.0.size();
    let raw = Strided::open(source, indices.buffer_view, indices.byte_offset.0, replaced, index_size, user)?;
    let values = Strided::open(source, values.buffer_view, values.byte_offset.0, replaced, size, user)?;
    // The allocation is bounded, because all values have been found in the file.
    let mut indices: Vec<(u32, usize)> = (0..).map_while(|place| Some((unsigned(raw.get(place)?), place))).collect();
    // The specification requires increasing indices. Among equal ones the last value counts.
    indices.reverse();
    indices.sort_by_key(|&(index, _)| index);
    indices.dedup_by_key(|(index, _)| *index);
    match indices.last() {
        Some(&(last, _)) if u64::from(last) >= count => Err(reason(format!("index {last} is out of range of {count}"))),
        _ => Ok((indices, values)),
    }
}

/// A little-endian unsigned integer of one, two or four bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |number, &byte| number << 8 | u32::from(byte))
}

fn real(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let bits = unsigned(bytes);
    let (value, largest) = match component {
        ComponentType::F32 => return f32::from_bits(bits),
        ComponentType::U32 => return bits as f32,
        ComponentType::I8 => (f32::from(bits as u8 as i8), 127.0),
        ComponentType::U8 => (bits as f32, 255.0),
        ComponentType::I16 => (f32::from(bits as u16 as i16), 32_767.0),
        ComponentType::U16 => (bits as f32, 65_535.0),
    };
    // Without the maximum, the most negative integer would lie below −1.
    if normalized { (value / largest).max(-1.0) } else { value }
}

fn shape_name(shape: Type) -> &'static str {
    match shape {
        Type::Scalar => "SCALAR",
        Type::Vec2 => "VEC2",
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        Type::Mat2 => "MAT2",
        Type::Mat3 => "MAT3",
        Type::Mat4 => "MAT4",
    }
}

fn component_name(component: ComponentType) -> &'static str {
    match component {
        ComponentType::I8 => "BYTE",
        ComponentType::U8 => "UNSIGNED_BYTE",
        ComponentType::I16 => "SHORT",
        ComponentType::U16 => "UNSIGNED_SHORT",
        ComponentType::U32 => "UNSIGNED_INT",
        ComponentType::F32 => "FLOAT",
    }
}
