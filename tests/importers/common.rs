//! Temporary folders and a glTF file under construction.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use asvgf::scene::{Loaded, SceneError, load};
use base64::Engine as _;
use serde_json::{Value, json};

pub const F32: u32 = 5126;
pub const U32: u32 = 5125;
pub const U16: u32 = 5123;
pub const I16: u32 = 5122;
pub const U8: u32 = 5121;
pub const I8: u32 = 5120;

/// A folder for one test, removed at its end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let name = format!("asvgf-importers-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes a file, and makes its folders.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, content).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A glTF file under construction: one scene with one node with one mesh without primitives, and one buffer.
#[derive(Clone)]
pub struct Gltf {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Gltf {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}],
            "accessors": [], "bufferViews": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// A file with one right-angled triangle of area ½ in the plane z = 0, without indices.
    pub fn triangle() -> Self {
        let mut gltf = Self::new();
        let position = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        gltf.primitive(json!({"attributes": {"POSITION": position}}));
        gltf
    }

    /// The same triangle with texture coordinates.
    pub fn textured_triangle() -> Self {
        let mut gltf = Self::triangle();
        let uv = gltf.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uv);
        gltf.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        gltf
    }

    /// Adds an element to a list and returns its index. Makes the list if there is none.
    pub fn push(&mut self, list: &str, element: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(element);
        list.len() - 1
    }

    pub fn primitive(&mut self, primitive: Value) {
        self.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn accessor(&mut self, component: u32, shape: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({"bufferView": view, "componentType": component, "type": shape, "count": count}))
    }

    pub fn floats(&mut self, shape: &str, numbers: &[f32]) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        self.accessor(F32, shape, numbers.len() / width, &le(numbers.iter().map(|x| x.to_le_bytes())))
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        self.accessor(U16, "SCALAR", indices.len(), &le(indices.iter().map(|x| x.to_le_bytes())))
    }

    /// The text of the file, with its buffer in a data URI.
    pub fn text(&self) -> String {
        let mut json = self.json.clone();
        if json["buffers"].is_null() && !self.bytes.is_empty() {
            json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": self.data_uri()}]);
        }
        json.to_string()
    }

    pub fn data_uri(&self) -> String {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        format!("data:application/octet-stream;base64,{data}")
    }

    /// The text of the file in a GLB file.
    pub fn text_of_glb(&self) -> String {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        json.to_string()
    }

    /// The file as a GLB file.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.text_of_glb().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        glb(&[(b"JSON", &json), (b"BIN\0", &binary)])
    }

    pub fn load(&self) -> Result<Loaded, SceneError> {
        self.load_in(&Folder::new())
    }

    pub fn load_in(&self, folder: &Folder) -> Result<Loaded, SceneError> {
        load(folder.write("test.gltf", self.text()))
    }
}

/// Changes or adds a value anywhere in a file.
pub fn set(pointer: &str, value: Value) -> impl FnOnce(&mut Gltf) {
    let (parent, name) = pointer.rsplit_once('/').map(|(parent, name)| (parent.to_owned(), name.to_owned())).unwrap();
    move |gltf| {
        let parent = gltf.json.pointer_mut(&parent).unwrap();
        match parent {
            Value::Array(list) => list[name.parse::<usize>().unwrap()] = value,
            parent => parent[name] = value,
        }
    }
}

/// A GLB file made of chunks.
pub fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let length: usize = 12 + chunks.iter().map(|(_, chunk)| 8 + chunk.len()).sum::<usize>();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((length as u32).to_le_bytes());
    for (kind, chunk) in chunks {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(*kind);
        bytes.extend(*chunk);
    }
    bytes
}

/// Concatenates little-endian numbers.
pub fn le<const N: usize>(numbers: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
    numbers.flatten().collect()
}

/// A PNG file of one colour.
pub fn png(width: u32, height: u32, texel: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(width, height, image::Rgba(texel))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

/// Asserts that loading gave exactly these warnings: parts of each element and reason, in any order.
#[track_caller]
pub fn assert_warnings(loaded: &Loaded, expected: &[(&str, &str)]) {
    let warnings = &loaded.warnings;
    for (element, reason) in expected {
        assert!(
            warnings.iter().any(|warning| warning.element.contains(element) && warning.reason.contains(reason)),
            "no warning about {element}: {reason} in {warnings:#?}"
        );
    }
    assert_eq!(warnings.len(), expected.len(), "{warnings:#?}");
}

/// Asserts that loading fails, and that the error names the file, the element and the reason.
#[track_caller]
pub fn assert_error(result: Result<Loaded, SceneError>, file: &str, element: &str, reason: &str) {
    let error = result.map(|loaded| loaded.warnings).expect_err(&format!("{element}: {reason} was accepted"));
    assert!(
        error.file.contains(file) && error.element.contains(element) && error.reason.contains(reason),
        "«{error}» is not about {file}: {element}: {reason}"
    );
}

/// World-space bounds of a scene at rest.
#[track_caller]
pub fn bounds(loaded: &Loaded) -> [[f32; 3]; 2] {
    let bounds = loaded.scene.bounds(&loaded.scene.pose(None, 0.0)).unwrap();
    bounds.map(|corner| corner.map(|x| x as f32))
}

/// Surface area of a scene at rest.
pub fn area(loaded: &Loaded) -> f64 {
    loaded.scene.surface_area(&loaded.scene.pose(None, 0.0))
}

#[track_caller]
pub fn assert_close<T: Copy + Into<f64> + std::fmt::Debug>(actual: &[T], expected: &[f32], tolerance: f32) {
    let near = |a: T, b: f32| (a.into() - f64::from(b)).abs() <= f64::from(tolerance);
    let close = actual.len() == expected.len() && actual.iter().zip(expected).all(|(&a, &b)| near(a, b));
    assert!(close, "{actual:?} is not {expected:?}");
}

/// A file name for messages.
pub fn name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}
