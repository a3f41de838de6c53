//! Joints and bodies of ragdolls in the physics world.
//!
//! Each bone is tied by two joints. One locks the pivot and holds the limits: a cone between the X axes
//! of its frames (two coupled axes) and a twist about X. The other has only three motors, because the
//! engine drops motors on coupled axes; its first frame is turned to the target, so that all three
//! aim at zero, where their measure is exact.

mod limits;
mod motors;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{
    plugin::context::{
        RapierContextColliders, RapierContextEntityLink, RapierContextJoints,
        RapierContextSimulation, RapierRigidBodySet,
    },
    prelude::{RapierConfiguration, RapierRigidBodyHandle},
    rapier::{
        dynamics::{
            GenericJoint, ImpulseJointHandle, JointAxesMask, JointAxis, RigidBody,
            RigidBodyActivation, RigidBodyBuilder, RigidBodyHandle, RigidBodyType,
        },
        math::Pose,
    },
};

use super::handles::entity_of;

pub(crate) use limits::{AimedRows, JointFrames, JointRows, RowSpring};
pub(crate) use motors::MotorRows;

/// The angular axes, in order.
const TURNS: [JointAxis; 3] = [JointAxis::AngX, JointAxis::AngY, JointAxis::AngZ];
/// The linear axes, in order.
const SLIDES: [JointAxis; 3] = [JointAxis::LinX, JointAxis::LinY, JointAxis::LinZ];

/// A joint in the physics world. Its world forgets it together with either of its bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct JointHandle(ImpulseJointHandle);

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodyMotion {
    pub position: Vec3,
    pub rotation: Quat,
    /// Centre of mass, world, metres.
    pub center: Vec3,
    /// Of the centre of mass, metres per second.
    pub velocity: Vec3,
    /// Radians per second.
    pub spin: Vec3,
    pub sleeping: bool,
    pub dynamic: bool,
}

impl BodyMotion {
    /// Velocity of the body's origin, metres per second.
    pub fn origin_velocity(&self) -> Vec3 {
        self.velocity + self.spin.cross(self.position - self.center)
    }
}

/// Fixed bodies without colliders that pins are fastened to, one for each physics world.
#[derive(Resource, Default)]
pub(crate) struct PinAnchors(Vec<(Entity, RigidBodyHandle)>);

/// The physics worlds' settings.
pub(crate) type WorldSteps<'w, 's> = Query<'w, 's, (Entity, &'static mut RapierContextSimulation)>;

/// How often each physics world went over its joints before ragdolls asked for more, and what it was
/// then set to.
#[derive(Resource, Default)]
pub(crate) struct JointIterations(Vec<(Entity, usize, usize)>);

impl JointIterations {
    /// Lets the solver of each world go over the joints in each substep as often as the largest number
    /// that is asked for there, and no oftener once nobody asks.
    pub fn set(&mut self, worlds: &mut WorldSteps, asked: impl Fn(Entity) -> usize) {
        for (world, mut simulation) in worlds {
            let parameters = &mut simulation.bypass_change_detection().integration_parameters;
            let now = &mut parameters.num_internal_pgs_iterations;
            let known = self.0.iter().position(|(of, ..)| *of == world);
            let own = match known.map(|i| self.0[i]) {
                Some((_, own, set)) if set == *now => own,
                // The game has set it.
                _ => *now,
            };
            let wanted = own.max(asked(world));
            if let Some(known) = known {
                self.0[known] = (world, own, wanted);
            } else if wanted != own {
                self.0.push((world, own, wanted));
            }
            *now = wanted;
        }
    }
}

/// All physics worlds, for joints.
#[derive(SystemParam)]
pub(crate) struct JointWorlds<'w, 's> {
    contexts: Query<
        'w,
        's,
        (
            &'static mut RapierContextJoints,
            &'static mut RapierRigidBodySet,
            &'static mut RapierContextSimulation,
            &'static RapierConfiguration,
        ),
    >,
    colliders: Query<'w, 's, &'static RapierContextColliders>,
    anchors: ResMut<'w, PinAnchors>,
}

impl JointWorlds<'_, '_> {
    /// Gravity of the world that a body belongs to, metres per second squared, and whether it runs.
    pub fn gravity(&self, link: &RapierContextEntityLink) -> Option<(Vec3, bool)> {
        let (.., config) = self.contexts.get(link.0).ok()?;
        Some((config.gravity, config.physics_pipeline_active))
    }

    /// Whether a body touches anything that is not of an entity for which `own` holds.
    pub fn touches(
        &self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        own: impl Fn(Entity) -> bool,
    ) -> bool {
        let Ok((_, bodies, simulation, _)) = self.contexts.get(link.0) else {
            return false;
        };
        let Some(body) = bodies.bodies.get(handle.0) else {
            return false;
        };
        body.colliders().iter().any(|&collider| {
            let mut pairs = simulation.narrow_phase.contact_pairs_with(collider);
            pairs.any(|pair| {
                let other = if pair.collider1 == collider {
                    pair.collider2
                } else {
                    pair.collider1
                };
                let entity = self.colliders.get(link.0).ok().and_then(|colliders| {
                    let collider = colliders.colliders.get(other)?;
                    Some(entity_of(collider.user_data))
                });
                pair.has_any_active_contact() && entity.is_some_and(|entity| !own(entity))
            })
        })
    }

    /// How many substeps a tick has.
    pub fn substeps(&self, link: &RapierContextEntityLink) -> f32 {
        self.contexts.get(link.0).map_or(4.0, |(_, _, sim, _)| {
            sim.integration_parameters.num_solver_iterations.max(1) as f32
        })
    }

    /// Ties two bodies together; what they are tied by does not let them collide.
    pub fn tie(
        &mut self,
        link: &RapierContextEntityLink,
        first: &RapierRigidBodyHandle,
        second: &RapierRigidBodyHandle,
        frames: &JointFrames,
        rows: &JointRows,
        spring: Option<RowSpring>,
    ) -> Option<JointHandle> {
        let joint = limits::joint(frames, rows, spring);
        self.insert(link, first.0, second.0, joint)
    }

    /// Drives a body against another.
    pub fn motorize(
        &mut self,
        link: &RapierContextEntityLink,
        first: &RapierRigidBodyHandle,
        second: &RapierRigidBodyHandle,
        frames: &JointFrames,
    ) -> Option<JointHandle> {
        let joint = motors::joint(frames, &TURNS);
        self.insert(link, first.0, second.0, joint)
    }

    /// Drives a body against the world.
    pub fn pin(
        &mut self,
        link: &RapierContextEntityLink,
        body: &RapierRigidBodyHandle,
    ) -> Option<JointHandle> {
        let known = self.anchors.0.iter().find(|(world, _)| *world == link.0);
        let (_, mut bodies, ..) = self.contexts.get_mut(link.0).ok()?;
        let anchor = match known.map(|(_, anchor)| *anchor) {
            // Another set of bodies, as after a rollback, may have given the handle to something else.
            Some(anchor)
                if (bodies.bodies.get(anchor))
                    .is_some_and(|b| b.is_fixed() && b.colliders().is_empty()) =>
            {
                anchor
            }
            _ => {
                let anchor = bodies.bodies.insert(RigidBodyBuilder::fixed());
                self.anchors.0.retain(|(world, _)| *world != link.0);
                self.anchors.0.push((link.0, anchor));
                anchor
            }
        };
        let frames = JointFrames::default();
        let mut joint = motors::joint(&frames, &TURNS);
        for axis in SLIDES {
            motors::enable(&mut joint, axis);
        }
        joint.contacts_enabled = true;
        self.insert(link, anchor, body.0, joint)
    }

    /// Keeps two bodies from colliding, and nothing else.
    pub fn ignore(
        &mut self,
        link: &RapierContextEntityLink,
        first: &RapierRigidBodyHandle,
        second: &RapierRigidBodyHandle,
    ) -> Option<JointHandle> {
        let mut joint = GenericJoint::new(JointAxesMask::empty());
        joint.contacts_enabled = false;
        self.insert(link, first.0, second.0, joint)
    }

    fn insert(
        &mut self,
        link: &RapierContextEntityLink,
        first: RigidBodyHandle,
        second: RigidBodyHandle,
        joint: GenericJoint,
    ) -> Option<JointHandle> {
        let (mut joints, bodies, ..) = self.contexts.get_mut(link.0).ok()?;
        if first == second || !bodies.bodies.contains(first) || !bodies.bodies.contains(second) {
            return None;
        }
        let handle = joints
            .bypass_change_detection()
            .impulse_joints
            .insert(first, second, joint, true);
        Some(JointHandle(handle))
    }

    /// Takes a joint away.
    pub fn untie(&mut self, link: &RapierContextEntityLink, joint: JointHandle) {
        if let Ok((mut joints, ..)) = self.contexts.get_mut(link.0) {
            joints.impulse_joints.remove(joint.0, true);
        }
    }

    /// Impulse by which a joint held its pivot in the last substep, newton-seconds.
    pub fn load(&self, link: &RapierContextEntityLink, joint: JointHandle) -> f32 {
        let Ok((joints, ..)) = self.contexts.get(link.0) else {
            return 0.0;
        };
        let joint = joints.impulse_joints.get(joint.0);
        joint.map_or(0.0, |j| {
            Vec3::new(j.impulses[0], j.impulses[1], j.impulses[2]).length()
        })
    }

    /// Changes a joint in place, without waking its bodies.
    fn edit(
        &mut self,
        link: &RapierContextEntityLink,
        joint: JointHandle,
        change: impl FnOnce(&mut GenericJoint),
    ) {
        if let Ok((mut joints, ..)) = self.contexts.get_mut(link.0)
            && let Some(joint) = joints
                .bypass_change_detection()
                .impulse_joints
                .get_mut(joint.0, false)
        {
            change(&mut joint.data);
        }
    }

    /// Where a body is and how it moves.
    pub fn motion(
        &self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
    ) -> Option<BodyMotion> {
        let (_, bodies, ..) = self.contexts.get(link.0).ok()?;
        let body = bodies.bodies.get(handle.0)?;
        let pose = body.position();
        Some(BodyMotion {
            position: pose.translation,
            rotation: pose.rotation,
            center: body.center_of_mass(),
            velocity: body.linvel(),
            spin: body.angvel(),
            sleeping: body.is_sleeping(),
            dynamic: body.body_type() == RigidBodyType::Dynamic && body.is_enabled(),
        })
    }

    /// Puts a body somewhere, with the velocity of its origin.
    pub fn place(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        pose: Option<(Vec3, Quat)>,
        velocity: Vec3,
        spin: Vec3,
    ) {
        let sound = pose.is_none_or(|(p, r)| p.is_finite() && r.is_finite());
        if sound
            && velocity.is_finite()
            && spin.is_finite()
            && let Ok((_, mut bodies, ..)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
        {
            if let Some((position, rotation)) = pose {
                let pose = Pose::from_parts(position, rotation);
                body.set_position(pose, true);
                body.set_next_kinematic_position(pose);
            }
            let arm = body.center_of_mass() - body.position().translation;
            body.set_linvel(velocity + spin.cross(arm), true);
            body.set_angvel(spin, true);
        }
    }

    /// Sets the velocity of a body's centre of mass, and its spin.
    pub fn set_velocity(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        velocity: Vec3,
        spin: Vec3,
    ) {
        if velocity.is_finite()
            && spin.is_finite()
            && let Ok((_, mut bodies, ..)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
        {
            body.set_linvel(velocity, false);
            body.set_angvel(spin, false);
        }
    }

    /// Gives a dynamic body an impulse at a point of the world and wakes it.
    pub fn strike(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        impulse: Vec3,
        point: Vec3,
    ) {
        if impulse.is_finite()
            && point.is_finite()
            && let Ok((_, mut bodies, ..)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
            && body.is_dynamic()
        {
            body.apply_impulse_at_point(impulse, point, true);
        }
    }

    /// Sends a kinematic body to where it is at the end of the tick.
    pub fn send(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        position: Vec3,
        rotation: Quat,
    ) {
        if !(position.is_finite() && rotation.is_finite()) {
            return;
        }
        let Ok((_, mut bodies, ..)) = self.contexts.get_mut(link.0) else {
            return;
        };
        let there = |pose: &Pose| pose.translation == position && pose.rotation == rotation;
        let stands = |body: &RigidBody| there(body.position()) && there(body.next_position());
        // A body that is touched is gone over by the engine, also when nothing was changed.
        if bodies.bodies.get(handle.0).is_some_and(stands) {
            return;
        }
        if let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0) {
            // The engine takes the velocity from the difference of both as they are written: from the
            // same rotation with the other sign it would be a whole turn.
            let near = if body.rotation().dot(rotation) < 0.0 {
                -rotation
            } else {
                rotation
            };
            body.set_next_kinematic_position(Pose::from_parts(position, near));
        }
    }

    /// Wakes a body.
    pub fn wake(&mut self, link: &RapierContextEntityLink, handle: &RapierRigidBodyHandle) {
        if let Ok((_, mut bodies, ..)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
        {
            body.wake_up(true);
        }
    }

    /// Lets a body that is awake fall asleep while no point of it moves faster than this, metres per second;
    /// `None`: as any other body. One that the game keeps awake stays so.
    pub fn doze(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        speed: Option<f32>,
    ) {
        let Ok((_, mut bodies, simulation, _)) = self.contexts.get_mut(link.0) else {
            return;
        };
        let usual = RigidBodyActivation::default_normalized_linear_threshold();
        // The engine allows a body to move twice as far in a tick as its threshold says.
        let unit = 2.0 * simulation.integration_parameters.length_unit;
        let wanted = speed.map_or(usual, |speed| usual.max(speed / unit));
        let bodies = &mut bodies.bypass_change_detection().bodies;
        let differs = bodies.get(handle.0).is_some_and(|body| {
            let now = body.activation().normalized_linear_threshold;
            !body.is_sleeping() && now >= 0.0 && now != wanted
        });
        if differs && let Some(body) = bodies.get_mut(handle.0) {
            body.activation_mut().normalized_linear_threshold = wanted;
        }
    }

    /// Slows a body down to these speeds, metres and radians per second.
    pub fn cap(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        speed: f32,
        spin: f32,
    ) {
        if let Ok((_, mut bodies, ..)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
        {
            let (v, w) = (body.linvel(), body.angvel());
            if v.length_squared() > speed * speed {
                body.set_linvel(v.clamp_length_max(speed), false);
            }
            if w.length_squared() > spin * spin {
                body.set_angvel(w.clamp_length_max(spin), false);
            }
        }
    }
}
