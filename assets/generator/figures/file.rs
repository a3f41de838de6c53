//! Writes a figure as a binary glTF 2.0 file: one skinned mesh, one material, colours at corners.

use bevy::math::{DMat4, DQuat, DVec3, Vec3};
use serde_json::{Value, json};

use super::{
    clip::{Clip, Figure},
    skeleton::Skeleton,
    skin,
};
use crate::glb::{ARRAY, BYTE, Buffer, ELEMENTS, FLOAT, SHORT, pack, shorten};

/// Rounded to a millionth, the same on every machine.
fn round(value: f64) -> f32 {
    // Not `-0`.
    ((value * 1e6).round() / 1e6 + 0.0) as f32
}

fn vec3(v: DVec3) -> Vec3 {
    Vec3::new(round(v.x), round(v.y), round(v.z))
}

fn quat(q: DQuat) -> [f32; 4] {
    [round(q.x), round(q.y), round(q.z), round(q.w)]
}

/// Numbers that are not about corners: animation and matrices, without a target.
fn floats(buffer: &mut Buffer, kind: &str, width: usize, values: &[f32], bounds: bool) -> usize {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut accessor =
        json!({ "componentType": FLOAT, "count": values.len() / width, "type": kind });
    if bounds {
        let low = values.iter().copied().fold(f32::INFINITY, f32::min);
        let high = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        accessor["min"] = json!([low]);
        accessor["max"] = json!([high]);
    }
    let index = buffer.add(&bytes, ARRAY, accessor);
    let view = buffer.views.len() - 1;
    if let Some(view) = buffer.views[view].as_object_mut() {
        view.remove("target");
    }
    index
}

fn mesh(buffer: &mut Buffer, figure: &Figure) -> Value {
    let mut points = Vec::new();
    let mut normals = Vec::new();
    let (mut colors, mut joints, mut weights) = (Vec::new(), Vec::new(), Vec::new());
    let mut indices = Vec::new();
    for shell in &figure.shells {
        let first = points.len() as u32;
        let [r, g, b] = shell.color.map(|c| (c * 255.0).round() as u8);
        for (&point, &normal) in shell.points.iter().zip(&shell.normals) {
            points.push(vec3(point));
            normals.push(vec3(normal));
            colors.extend([r, g, b, 255]);
            let shares = skin::shares(&figure.skeleton, &figure.gates, point);
            for (bone, weight) in skin::weights(&shares) {
                joints.push(bone);
                weights.push(weight);
            }
        }
        indices.extend(shell.triangles.iter().flatten().map(|&i| first + i));
    }
    let count = points.len();
    let bytes = |buffer: &mut Buffer, bytes: &[u8], normalized: bool| {
        let mut accessor = json!({ "componentType": BYTE, "count": count, "type": "VEC4" });
        if normalized {
            accessor["normalized"] = json!(true);
        }
        buffer.add(bytes, ARRAY, accessor)
    };
    let attributes = json!({
        "POSITION": buffer.vectors(&points, true),
        "NORMAL": buffer.vectors(&normals, false),
        "COLOR_0": bytes(buffer, &colors, true),
        "JOINTS_0": bytes(buffer, &joints, false),
        "WEIGHTS_0": bytes(buffer, &weights, true),
    });
    let corners: Vec<u8> = indices
        .iter()
        .flat_map(|&i| (i as u16).to_le_bytes())
        .collect();
    let indices = buffer.add(
        &corners,
        ELEMENTS,
        json!({ "componentType": SHORT, "count": indices.len(), "type": "SCALAR" }),
    );
    json!({
        "name": figure.name,
        "primitives": [{ "attributes": attributes, "indices": indices, "material": 0 }],
    })
}

/// From the model to the bone, in the bind pose.
pub fn inverse_bind(skeleton: &Skeleton, bone: usize) -> DMat4 {
    let bone = &skeleton.bones[bone];
    DMat4::from_rotation_translation(bone.frame(), bone.head).inverse()
}

fn animation(buffer: &mut Buffer, skeleton: &Skeleton, clip: &Clip) -> Value {
    let times: Vec<f32> = (0..clip.poses.len()).map(|i| round(clip.time(i))).collect();
    let times = floats(buffer, "SCALAR", 1, &times, true);
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut track = |buffer: &mut Buffer, node: usize, path: &str, values: &[f32]| {
        let (kind, width) = if path == "rotation" {
            ("VEC4", 4)
        } else {
            ("VEC3", 3)
        };
        channels.push(json!({
            "sampler": samplers.len(),
            "target": { "node": node, "path": path },
        }));
        samplers.push(json!({
            "input": times,
            "output": floats(buffer, kind, width, values, false),
            "interpolation": "LINEAR",
        }));
    };
    for bone in 0..skeleton.bones.len() {
        let nodes = clip.poses.iter().map(|pose| pose.node(skeleton, bone));
        if bone == 0 {
            let moves: Vec<f32> = nodes.clone().flat_map(|n| vec3(n.0).to_array()).collect();
            track(buffer, bone, "translation", &moves);
        }
        let turns: Vec<f32> = nodes.flat_map(|n| quat(n.1)).collect();
        track(buffer, bone, "rotation", &turns);
    }
    json!({
        "name": clip.name,
        "channels": channels,
        "samplers": samplers,
        // What plays the clip can match its rate to the ground.
        "extras": { "loops": clip.loops, "speed": round(clip.speed) },
    })
}

/// The whole file. Nodes are the bones in their order, then the mesh, then what holds both.
pub fn encode(figure: &Figure) -> Result<Vec<u8>, serde_json::Error> {
    let mut buffer = Buffer::default();
    let skeleton = &figure.skeleton;
    let count = skeleton.bones.len();
    let bind = super::skeleton::Pose::bind(skeleton);
    let mut nodes: Vec<Value> = (0..count)
        .map(|bone| {
            let (at, turn) = bind.node(skeleton, bone);
            let children: Vec<usize> = (0..count)
                .filter(|&child| skeleton.bones[child].parent == Some(bone))
                .collect();
            let mut node = json!({
                "name": skeleton.bones[bone].name,
                "translation": vec3(at).to_array(),
                "rotation": quat(turn),
            });
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        })
        .collect();
    nodes.push(json!({ "name": "body", "mesh": 0, "skin": 0 }));
    nodes.push(json!({ "name": figure.name, "children": [0, count] }));
    let mesh = mesh(&mut buffer, figure);
    let matrices: Vec<f32> = (0..count)
        .flat_map(|bone| inverse_bind(skeleton, bone).to_cols_array())
        .map(round)
        .collect();
    let matrices = floats(&mut buffer, "MAT4", 16, &matrices, false);
    let animations: Vec<Value> = figure
        .clips
        .iter()
        .map(|clip| animation(&mut buffer, skeleton, clip))
        .collect();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "bevy_embody figure generator" },
        "scene": 0,
        "scenes": [{ "name": figure.name, "nodes": [count + 1] }],
        "nodes": nodes,
        "meshes": [mesh],
        "materials": [{
            "name": figure.name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [1.0, 1.0, 1.0, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.8,
            },
        }],
        "skins": [{
            "name": figure.name,
            "inverseBindMatrices": matrices,
            "skeleton": 0,
            "joints": (0..count).collect::<Vec<_>>(),
        }],
        "animations": animations,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    shorten(&mut document);
    pack(&document, buffer.bytes)
}
