//! Draws what each joint of a ragdoll allows, oversteps and is asked for.

use bevy::{color::palettes::tailwind, gizmos::config::GizmoConfigGroup, prelude::*};

use crate::ragdoll::{BoneOutput, Bones, PlannedBone, RagdollBone, RagdollPlan, RagdollState};

/// Lines around a cone.
const LINES: usize = 32;

/// Draws every ragdoll's bodies, cones, twists, violations and drive errors; see [`RagdollGizmos`] for
/// what is drawn how.
///
/// Drawing needs a renderer: in a game that has Bevy's default plugins this works as it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct RagdollDebugPlugin;

impl Plugin for RagdollDebugPlugin {
    fn build(&self, app: &mut App) {
        app.insert_gizmo_config(
            RagdollGizmos::default(),
            GizmoConfig {
                depth_bias: -0.02,
                ..default()
            },
        )
        .add_systems(PostUpdate, draw_bones.after(TransformSystems::Propagate));
    }
}

/// What is drawn of each bone. Change it, or switch all of it off, through Bevy's
/// [`GizmoConfigStore`].
#[derive(Clone, Copy, Debug, Reflect, GizmoConfigGroup)]
#[reflect(Default)]
pub struct RagdollGizmos {
    /// The line of the body: green where it is simulated, grey where it sleeps or follows the pose.
    pub body: bool,
    /// The boundary of the swing in light blue, with a line to where the bone is.
    pub cone: bool,
    /// The range of the twist as a violet arc, with a line at the present twist.
    pub twist: bool,
    /// A red circle about a joint beyond its limits, the larger the farther.
    pub violation: bool,
    /// An orange line from where the bone points to where it is asked to point.
    pub error: bool,
    /// Length of what is drawn of a joint, metres.
    pub size: f32,
}

impl Default for RagdollGizmos {
    fn default() -> Self {
        Self {
            body: true,
            cone: true,
            twist: true,
            violation: true,
            error: true,
            size: 0.12,
        }
    }
}

fn draw_bones(
    mut gizmos: Gizmos<RagdollGizmos>,
    ragdolls: Query<(&RagdollPlan, &RagdollState, &Bones)>,
    bones: Query<(&RagdollBone, &GlobalTransform, &BoneOutput)>,
) {
    let shown = *gizmos.config_ext;
    for (plan, state, tied) in &ragdolls {
        for (bone, place, output) in bones.iter_many(tied.iter()) {
            let Some(planned) = plan.bones.get(bone.order) else {
                continue;
            };
            let (_, rotation, at) = place.to_scale_rotation_translation();
            if !(at.is_finite() && rotation.is_finite()) {
                continue;
            }
            if shown.body {
                let (a, b, radius) = planned.shape.core();
                let color = if output.simulated && !output.asleep {
                    tailwind::GREEN_400
                } else {
                    tailwind::GRAY_400
                };
                gizmos.line(at + rotation * a, at + rotation * b, color);
                let isometry = Isometry3d::new(at + rotation * ((a + b) * 0.5), rotation);
                gizmos.sphere(isometry, radius * 0.2, color);
            }
            let parent = planned.parent.and_then(|p| {
                let mut all = bones.iter_many(tied.iter());
                all.find(|b| b.0.order == p)
            });
            let Some((_, parent, _)) = parent else {
                continue;
            };
            let parent = parent.rotation();
            draw_joint(&mut gizmos, planned, at, parent, rotation, output);
            let asked = |i: usize| state.bones.get(i).and_then(|b| b.target);
            if shown.error
                && let Some((own, of)) = asked(bone.order).zip(planned.parent.and_then(asked))
                && output.error > 0.01
            {
                let asked = parent * of.rotation.inverse() * own.rotation;
                let tip = |turn: Quat| at + turn * planned.along() * shown.size;
                gizmos.line(tip(rotation), tip(asked), tailwind::ORANGE_500);
            }
        }
    }
}

/// What a joint allows, and whether it keeps to it.
fn draw_joint(
    gizmos: &mut Gizmos<RagdollGizmos>,
    planned: &PlannedBone,
    at: Vec3,
    parent: Quat,
    rotation: Quat,
    output: &BoneOutput,
) {
    let shown = *gizmos.config_ext;
    let along = planned.along();
    if shown.cone && planned.rim(0.0).is_some() {
        let rim = (0..=LINES).filter_map(|i| {
            let q = planned.rim(i as f32 / LINES as f32)?;
            Some(at + planned.child_of(parent, q) * along * shown.size)
        });
        gizmos.linestrip(rim, tailwind::SKY_300);
        gizmos.line(at, at + rotation * along * shown.size, tailwind::SKY_300);
    }
    if shown.twist
        && let Some((min, max)) = planned.twist()
    {
        let axes = parent * planned.frames.rotation1;
        let reach = 0.5 * shown.size;
        let arc = (0..=LINES).map(|i| {
            let turn = min + (max - min) * i as f32 / LINES as f32;
            at + axes * PlannedBone::across(turn) * reach
        });
        gizmos.linestrip(arc, tailwind::VIOLET_400);
        let now = planned.joint_rotation(parent, rotation);
        gizmos.line(
            at,
            at + axes * (now * Vec3::Y) * reach,
            tailwind::VIOLET_400,
        );
    }
    if shown.violation && output.violation > 0.01 {
        let isometry = Isometry3d::new(at, rotation);
        let radius = shown.size * (0.2 + output.violation);
        gizmos.sphere(isometry, radius, tailwind::RED_500);
    }
}
