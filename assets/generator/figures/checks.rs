//! What must hold of every figure and of its file.

use std::collections::HashMap;

use bevy::math::{DVec3, Mat4, Quat, Vec3};

use super::{
    Figure, all,
    clip::Clip,
    dog, encode,
    human::{bones::at, limits},
    skeleton::{Bone, Place, Pose},
    skin,
};

/// A pose between the keys, as a player makes it.
fn between(clip: &Clip, part: f64) -> Pose {
    let at = part * (clip.poses.len() - 1) as f64;
    let key = (at.floor() as usize).min(clip.poses.len() - 2);
    let (a, b, t) = (&clip.poses[key], &clip.poses[key + 1], at - key as f64);
    Pose {
        shift: a.shift.lerp(b.shift, t),
        turns: a
            .turns
            .iter()
            .zip(&b.turns)
            .map(|(a, b)| a.slerp(*b, t))
            .collect(),
    }
}

fn every(mut check: impl FnMut(&Figure, &Clip)) {
    for figure in all() {
        for clip in &figure.clips {
            check(&figure, clip);
        }
    }
}

fn clip<'a>(figure: &'a Figure, name: &str) -> &'a Clip {
    let found = figure.clips.iter().find(|clip| clip.name == name);
    found.expect("the clip is there")
}

/// Where a point of the bind pose goes that is rigidly tied to a bone.
fn carry(place: Place, bone: &Bone, point: DVec3) -> DVec3 {
    place.at + place.turn * (point - bone.head)
}

/// Where the skin is in a pose.
fn skinned(figure: &Figure, pose: &Pose, held: &[(DVec3, skin::Weights)]) -> Vec<DVec3> {
    let bones = &figure.skeleton.bones;
    let places: Vec<_> = (0..bones.len())
        .map(|bone| pose.place(&figure.skeleton, bone))
        .collect();
    held.iter()
        .map(|(point, weights)| {
            weights
                .iter()
                .map(|&(bone, weight)| {
                    let bone = usize::from(bone);
                    carry(places[bone], &bones[bone], *point) * (f64::from(weight) / 255.0)
                })
                .sum()
        })
        .collect()
}

fn held(figure: &Figure) -> Vec<(DVec3, skin::Weights)> {
    let weights = |p| skin::weights(&skin::shares(&figure.skeleton, &figure.gates, p));
    figure
        .shells
        .iter()
        .flat_map(|shell| shell.points.iter().map(|&p| (p, weights(p))))
        .collect()
}

#[test]
fn the_weights_of_every_point_add_up_to_one() {
    for figure in all() {
        for (point, weights) in held(&figure) {
            let sum: u32 = weights.iter().map(|&(_, weight)| u32::from(weight)).sum();
            assert_eq!(sum, 255, "{} at {point}", figure.name);
            let shares = skin::shares(&figure.skeleton, &figure.gates, point);
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn every_bone_holds_some_skin() {
    for figure in all() {
        let mut most = vec![0; figure.skeleton.bones.len()];
        for (_, weights) in held(&figure) {
            for (bone, weight) in weights {
                let most = &mut most[usize::from(bone)];
                *most = weight.max(*most);
            }
        }
        for (bone, most) in figure.skeleton.bones.iter().zip(most) {
            assert!(most > 120, "{} holds only {most}/255", bone.name);
        }
    }
}

#[test]
fn every_shell_is_closed_and_looks_outwards() {
    for figure in all() {
        for shell in &figure.shells {
            let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
            let mut volume = 0.0;
            for &[a, b, c] in &shell.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((from, to)).or_default() += 1;
                }
                let [p, q, r] = [a, b, c].map(|i| shell.points[i as usize]);
                volume += p.dot(q.cross(r)) / 6.0;
                let normal: DVec3 = [a, b, c].iter().map(|&i| shell.normals[i as usize]).sum();
                let flat = (q - p).cross(r - p);
                assert!(
                    flat.length() < 1e-6 || flat.normalize().dot(normal) > 0.0,
                    "{}: a triangle at {p} looks inwards",
                    figure.name
                );
            }
            assert!(volume > 0.0, "{} is inside out", figure.name);
            for (&(from, to), &count) in &edges {
                assert_eq!(count, 1, "an edge of more than two triangles");
                assert!(edges.contains_key(&(to, from)), "an open edge");
            }
        }
    }
}

#[test]
fn loops_end_as_they_start_and_pass_their_seam_without_a_jerk() {
    every(|figure, clip| {
        if !clip.loops {
            return;
        }
        let (first, last) = (&clip.poses[0], &clip.poses[clip.poses.len() - 1]);
        let before = &clip.poses[clip.poses.len() - 2];
        let after = &clip.poses[1];
        assert!(first.shift.distance(last.shift) < 1e-9);
        let rate = (clip.poses.len() - 1) as f64 / clip.duration;
        let step = |bone: usize, from: &Pose, to: &Pose| {
            (from.turns[bone].inverse() * to.turns[bone]).to_scaled_axis()
        };
        // Paws and heels that strike turn sharply; nothing else does.
        let most = clip
            .poses
            .windows(3)
            .flat_map(|w| {
                (0..w[0].turns.len())
                    .map(|bone| (step(bone, &w[0], &w[1]) - step(bone, &w[1], &w[2])).length())
            })
            .fold(0.0, f64::max);
        for (bone, (a, b)) in first.turns.iter().zip(&last.turns).enumerate() {
            let name = format!(
                "{} {} {}",
                figure.name, clip.name, figure.skeleton.bones[bone].name
            );
            assert!(a.dot(*b).abs() > 1.0 - 1e-9, "{name} is not closed");
            let jump = (step(bone, before, last) - step(bone, first, after)).length();
            assert!(
                jump <= 1.2 * most + 1e-6,
                "{name}: {} rad/s at the seam, {} elsewhere",
                jump * rate,
                most * rate
            );
        }
    });
}

#[test]
fn no_bone_turns_faster_than_a_body_can() {
    every(|figure, clip| {
        let step = clip.duration / (clip.poses.len() - 1) as f64;
        for pair in clip.poses.windows(2) {
            for (bone, (a, b)) in pair[0].turns.iter().zip(&pair[1].turns).enumerate() {
                let rate = a.angle_between(*b) / step;
                let name = &figure.skeleton.bones[bone].name;
                assert!(
                    rate < 25.0,
                    "{} {}: {name} at {rate} rad/s",
                    figure.name,
                    clip.name
                );
            }
        }
    });
}

#[test]
fn no_clip_of_the_human_leaves_the_limits_of_its_joints() {
    let human = super::human::figure();
    let mut poses = vec![("bind", 0.0, Pose::bind(&human.skeleton))];
    for clip in &human.clips {
        let steps = 2 * clip.poses.len();
        for i in 0..=steps {
            let part = i as f64 / steps as f64;
            poses.push((clip.name, part * clip.duration, between(clip, part)));
        }
    }
    for (name, time, pose) in poses {
        let (joint, beyond) = limits::worst(&human.skeleton, &pose);
        assert!(
            beyond < 0.5,
            "{name} at {time:.2} s: {joint} by {beyond:.1} degrees"
        );
    }
}

/// How far a foot slides over the ground in a cycle, metres: of its spots that are down the one
/// that slides least, for the others roll off it.
fn slip(figure: &Figure, clip: &Clip, spots: &[(&str, DVec3)]) -> f64 {
    let steps = 400;
    let spots = |part: f64| {
        let pose = between(clip, part);
        let at = |&(bone, spot): &(&str, DVec3)| {
            let bone = figure.skeleton.find(bone);
            let place = pose.place(&figure.skeleton, bone);
            carry(place, &figure.skeleton.bones[bone], spot)
        };
        spots.iter().map(at).collect::<Vec<_>>()
    };
    let ground = clip.speed * clip.duration / f64::from(steps);
    let part = |i: i32| f64::from(i) / f64::from(steps);
    (0..steps)
        .filter_map(|i| {
            let down = |p: &DVec3| p.y < 0.004;
            spots(part(i))
                .into_iter()
                .zip(spots(part(i + 1)))
                .filter(|(p, q)| down(p) && down(q))
                .map(|(p, q)| (q - p + DVec3::Z * ground).length())
                .min_by(f64::total_cmp)
        })
        .sum()
}

#[test]
fn feet_that_are_down_do_not_slide_over_the_ground_that_passes() {
    let floor = |p: DVec3| DVec3::new(p.x, 0.0, p.z);
    let (human, dog) = (super::human::figure(), dog::figure());
    let foot = [("leftFoot", at::HEEL), ("leftToes", floor(at::BALL))];
    let front = floor(dog::bones::at::FRONT[4]);
    let back = floor(dog::bones::at::BACK[3]);
    for (figure, name, spots) in [
        (&human, "walk", &foot[..]),
        (&human, "run", &foot[..]),
        (&dog, "walk", &[("leftFrontToes", front)][..]),
        (
            &dog,
            "walk",
            &[("rightBackToes", back * DVec3::new(-1.0, 1.0, 1.0))][..],
        ),
        (&dog, "trot", &[("leftBackToes", back)][..]),
    ] {
        let clip = clip(figure, name);
        let slides = slip(figure, clip, spots);
        assert!(slides < 0.03, "{} {name}: {slides} m", figure.name);
        let mut lazy = clip.clone();
        lazy.speed *= 0.8;
        let faulty = slip(figure, &lazy, spots);
        assert!(faulty > 0.06, "a wrong speed is seen: {faulty} m");
    }
}

#[test]
fn nothing_goes_through_the_floor() {
    for figure in all() {
        let held = held(&figure);
        for clip in &figure.clips {
            for key in 0..clip.poses.len() {
                let skin = skinned(&figure, &clip.poses[key], &held);
                let low = skin.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
                assert!(
                    low > -0.015,
                    "{} {} at {:.2} s: {low:.3} m",
                    figure.name,
                    clip.name,
                    clip.time(key)
                );
            }
        }
    }
}

#[test]
fn clips_that_are_not_loops_end_standing() {
    let human = super::human::figure();
    let stand = &clip(&human, "idle").poses[0];
    every(|figure, clip| {
        if figure.name != "human" || clip.loops {
            return;
        }
        let last = &clip.poses[clip.poses.len() - 1];
        assert!(last.shift.distance(stand.shift) < 1e-6, "{}", clip.name);
        for (a, b) in last.turns.iter().zip(&stand.turns) {
            assert!(a.angle_between(*b) < 1e-4, "{}", clip.name);
        }
    });
}

#[test]
fn the_files_are_small_and_sound() {
    for figure in all() {
        let bytes = encode(&figure).expect("it can be encoded");
        assert!(
            bytes.len() < 400_000,
            "{}: {} bytes",
            figure.name,
            bytes.len()
        );
        let file = gltf::Gltf::from_slice(&bytes).expect("it is glTF");
        let blob = file.blob.as_deref().expect("it has a buffer");
        let buffer = |_: gltf::Buffer<'_>| Some(blob);
        for view in file.views() {
            assert_eq!(view.offset() % 4, 0);
            assert!(view.offset() + view.length() <= blob.len());
        }
        let skin = file.skins().next().expect("it has a skin");
        let mut global = HashMap::new();
        let mut open: Vec<_> = file
            .scenes()
            .flat_map(|scene| scene.nodes())
            .map(|node| (node, Mat4::IDENTITY))
            .collect();
        while let Some((node, above)) = open.pop() {
            let here = above * Mat4::from_cols_array_2d(&node.transform().matrix());
            global.insert(node.index(), here);
            open.extend(node.children().map(|child| (child, here)));
        }
        let inverse = skin.reader(buffer).read_inverse_bind_matrices();
        for (joint, inverse) in skin.joints().zip(inverse.expect("they are there")) {
            let product = global[&joint.index()] * Mat4::from_cols_array_2d(&inverse);
            assert!(
                product.abs_diff_eq(Mat4::IDENTITY, 1e-5),
                "{:?}: {product}",
                joint.name()
            );
        }
        for mesh in file.meshes() {
            for primitive in mesh.primitives() {
                let reader = primitive.reader(buffer);
                let points: Vec<Vec3> = reader
                    .read_positions()
                    .expect("it has points")
                    .map(Vec3::from)
                    .collect();
                let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
                let bounds = primitive.bounding_box();
                assert_eq!(low.to_array(), bounds.min);
                let joints = skin.joints().count() as u16;
                let used = reader.read_joints(0).expect("it has joints").into_u16();
                assert!(used.flatten().all(|joint| joint < joints));
                let corners = reader.read_indices().expect("it has corners").into_u32();
                assert!(corners.max() == Some(points.len() as u32 - 1));
            }
        }
        for animation in file.animations() {
            for channel in animation.channels() {
                let reader = channel.reader(buffer);
                let times: Vec<f32> = reader.read_inputs().expect("it has times").collect();
                assert!(times[0] == 0.0 && times.windows(2).all(|pair| pair[0] < pair[1]));
                use gltf::animation::util::ReadOutputs;
                match reader.read_outputs() {
                    Some(ReadOutputs::Rotations(turns)) => {
                        let turns: Vec<_> = turns.into_f32().map(Quat::from_array).collect();
                        assert_eq!(turns.len(), times.len());
                        assert!(turns.iter().all(|turn| (turn.length() - 1.0).abs() < 1e-4));
                    }
                    Some(ReadOutputs::Translations(moves)) => assert_eq!(moves.len(), times.len()),
                    _ => panic!("only turns and moves are written"),
                }
            }
        }
    }
}

#[test]
fn the_files_are_what_the_generator_makes() {
    for figure in all() {
        let made = encode(&figure).expect("it can be encoded");
        let found = std::fs::read(super::path(&figure)).expect("it is there");
        assert!(
            made == found,
            "{}.glb is not what the generator makes",
            figure.name
        );
    }
}
