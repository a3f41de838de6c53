//! Writes a level as a binary glTF 2.0 file.

use std::collections::BTreeSet;

use bevy::math::Vec3;
use embody_scenes::course::extras::{EXTRAS_KEY, NodeExtras};
use serde_json::{Value, json};

use crate::{
    level::Level,
    mesh::{Mesh, Part},
    paint::Paint,
};

pub const FLOAT: u32 = 5126;
pub const BYTE: u32 = 5121;
pub const SHORT: u32 = 5123;
const INT: u32 = 5125;
pub const ARRAY: u32 = 34962;
pub const ELEMENTS: u32 = 34963;

/// The buffer and what lies where in it.
#[derive(Default)]
pub struct Buffer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an array of its own view and returns its accessor.
    pub fn add(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": self.bytes.len(),
            "byteLength": bytes.len(),
            "target": target,
        }));
        self.bytes.extend_from_slice(bytes);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    pub fn vectors(&mut self, vectors: &[Vec3], bounds: bool) -> usize {
        let bytes: Vec<u8> = vectors
            .iter()
            .flat_map(Vec3::to_array)
            .flat_map(f32::to_le_bytes)
            .collect();
        let mut accessor =
            json!({ "componentType": FLOAT, "count": vectors.len(), "type": "VEC3" });
        if bounds {
            let low = vectors.iter().copied().fold(Vec3::INFINITY, Vec3::min);
            let high = vectors.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
            accessor["min"] = json!(low.to_array());
            accessor["max"] = json!(high.to_array());
        }
        self.add(&bytes, ARRAY, accessor)
    }

    fn primitive(&mut self, material: usize, part: &Part) -> Value {
        let mut attributes = json!({
            "POSITION": self.vectors(&part.positions, true),
            "NORMAL": self.vectors(&part.normals, false),
        });
        if part.tints.iter().any(|tint| *tint != [255; 3]) {
            let bytes: Vec<u8> = part
                .tints
                .iter()
                .flat_map(|&[r, g, b]| [r, g, b, 255])
                .collect();
            attributes["COLOR_0"] = json!(self.add(
                &bytes,
                ARRAY,
                json!({
                    "componentType": BYTE,
                    "normalized": true,
                    "count": part.tints.len(),
                    "type": "VEC4",
                }),
            ));
        }
        let small = part.positions.len() < usize::from(u16::MAX);
        let bytes: Vec<u8> = part
            .indices
            .iter()
            .flat_map(|i| i.to_le_bytes()[..if small { 2 } else { 4 }].to_vec())
            .collect();
        let indices = self.add(
            &bytes,
            ELEMENTS,
            json!({
                "componentType": if small { SHORT } else { INT },
                "count": part.indices.len(),
                "type": "SCALAR",
            }),
        );
        json!({
            "attributes": attributes,
            "indices": indices,
            "material": material,
        })
    }
}

fn material(paint: Paint) -> Value {
    let mut material = json!({
        "name": paint.name(),
        "pbrMetallicRoughness": {
            "baseColorFactor": paint.linear(),
            "metallicFactor": paint.metallic(),
            "roughnessFactor": paint.roughness(),
        },
    });
    if paint.alpha() < 1.0 {
        material["alphaMode"] = json!("BLEND");
    }
    material
}

/// The whole file.
pub fn encode(level: &Level) -> Result<Vec<u8>, serde_json::Error> {
    let mut buffer = Buffer::default();
    // Only what is used, in the order of the palette.
    let used: BTreeSet<Paint> = level
        .nodes
        .iter()
        .flat_map(|node| node.mesh.parts.keys().copied())
        .collect();
    let mut meshes: Vec<Value> = Vec::new();
    let mut known: Vec<&Mesh> = Vec::new();
    let mut nodes = Vec::new();
    for node in &level.nodes {
        let mut json = json!({ "name": node.name });
        let at = node.transform;
        if at.translation != Vec3::ZERO {
            json["translation"] = json!(at.translation.to_array());
        }
        if at.rotation != bevy::math::Quat::IDENTITY {
            json["rotation"] = json!(at.rotation.to_array());
        }
        if !node.mesh.parts.is_empty() {
            // Things that look the same share a mesh.
            let mesh = match known.iter().position(|mesh| mesh.same(&node.mesh)) {
                Some(mesh) => mesh,
                None => {
                    let primitives: Vec<Value> = node
                        .mesh
                        .parts
                        .iter()
                        .map(|(paint, part)| buffer.primitive(used.range(..paint).count(), part))
                        .collect();
                    meshes.push(json!({ "name": node.name, "primitives": primitives }));
                    known.push(&node.mesh);
                    meshes.len() - 1
                }
            };
            json["mesh"] = json!(mesh);
        }
        if node.extras != NodeExtras::default() {
            json["extras"] = json!({ EXTRAS_KEY: serde_json::to_value(&node.extras)? });
        }
        shorten(&mut json);
        nodes.push(json);
    }
    let document = json!({
        "asset": { "version": "2.0", "generator": "bevy_embody course generator" },
        "scene": 0,
        "scenes": [{ "name": level.name, "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": used.iter().copied().map(material).collect::<Vec<_>>(),
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    pack(&document, buffer.bytes)
}

/// The file of a document and its one buffer.
pub fn pack(document: &Value, mut binary: Vec<u8>) -> Result<Vec<u8>, serde_json::Error> {
    let mut text = serde_json::to_vec(document)?;
    pad(&mut text, b' ');
    pad(&mut binary, 0);
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut file = Vec::with_capacity(length);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}

/// Writes single-precision numbers as short as they are, 0.2 instead of 0.20000000298023224.
pub fn shorten(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            if let Some(short) = number
                .as_f64()
                .and_then(|wide| format!("{}", wide as f32).parse::<f64>().ok())
            {
                *value = json!(short);
            }
        }
        Value::Array(all) => all.iter_mut().for_each(shorten),
        Value::Object(all) => all.values_mut().for_each(shorten),
        _ => {}
    }
}

fn pad(bytes: &mut Vec<u8>, with: u8) {
    while !bytes.len().is_multiple_of(4) {
        bytes.push(with);
    }
}
