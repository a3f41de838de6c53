//! Writes a figure as a binary glTF 2.0 file: one skinned mesh, one material, colours at corners.

use bevy::math::{DMat4, DQuat, DVec3, Vec3};
use serde_json::{Value, json};

use super::{
    clip::{Clip, Figure},
    skeleton::Skeleton,
    skin,
};
use crate::glb::{ARRAY, BYTE, Buffer, ELEMENTS, FLOAT, SHORT, pack, shorten};

const SIGNED_SHORT: u32 = 5122;

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

/// Sixteen bits are finer than a hundredth of a degree.
fn short(value: f64) -> [u8; 2] {
    ((value * 32767.0).round() as i16).to_le_bytes()
}

/// Adds what is not about corners: animation and matrices, in a view without a target.
fn plain(buffer: &mut Buffer, bytes: &[u8], accessor: Value) -> usize {
    let index = buffer.add(bytes, ARRAY, accessor);
    if let Some(view) = buffer.views.last_mut().and_then(Value::as_object_mut) {
        view.remove("target");
    }
    index
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
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
    let count = clip.poses.len();
    let times: Vec<f32> = (0..count).map(|i| round(clip.time(i))).collect();
    let times = plain(
        buffer,
        &floats(&times),
        json!({
            "componentType": FLOAT,
            "count": count,
            "type": "SCALAR",
            "min": [0.0],
            "max": [round(clip.duration)],
        }),
    );
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut track = |node: usize, path: &str, output: usize| {
        channels.push(json!({
            "sampler": samplers.len(),
            "target": { "node": node, "path": path },
        }));
        samplers.push(json!({ "input": times, "output": output }));
    };
    for bone in 0..skeleton.bones.len() {
        let nodes = clip.poses.iter().map(|pose| pose.node(skeleton, bone));
        if bone == 0 {
            let moves: Vec<f32> = nodes
                .clone()
                .flat_map(|(at, _)| vec3(at).to_array())
                .collect();
            let accessor = json!({ "componentType": FLOAT, "count": count, "type": "VEC3" });
            track(
                bone,
                "translation",
                plain(buffer, &floats(&moves), accessor),
            );
        }
        let turns: Vec<u8> = nodes
            .flat_map(|(_, turn)| turn.to_array())
            .flat_map(short)
            .collect();
        let accessor = json!({
            "componentType": SIGNED_SHORT,
            "normalized": true,
            "count": count,
            "type": "VEC4",
        });
        track(bone, "rotation", plain(buffer, &turns, accessor));
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
    let matrices = plain(
        &mut buffer,
        &floats(&matrices),
        json!({ "componentType": FLOAT, "count": count, "type": "MAT4" }),
    );
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
