//! What the tests of ragdolls share.

use bevy::{
    math::{Vec2, ops},
    prelude::*,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

pub use crate::support::{Findings, G, RATES, edit, insert};

/// A figure of 75 kg and 1.75 m, spawned with its feet at a point.
pub fn human(sim: &mut Sim, detail: HumanoidDetail, mode: RagdollMode, at: Vec3) -> Entity {
    let ragdoll = Ragdoll::new(RagdollProfile::humanoid(detail, 1.75), 75.0);
    figure(sim, ragdoll, mode, at)
}

pub fn figure(sim: &mut Sim, ragdoll: Ragdoll, mode: RagdollMode, at: Vec3) -> Entity {
    let intent = RagdollIntent { mode, ..default() };
    sim.spawn((ragdoll, intent, Transform::from_translation(at)))
}

/// A world with nothing in it but such a figure.
pub fn alone(hz: f64, detail: HumanoidDetail, mode: RagdollMode, at: Vec3) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    let entity = human(&mut sim, detail, mode, at);
    (sim, entity)
}

/// The same over level ground, with its feet at this height.
pub fn above_ground(hz: f64, detail: HumanoidDetail, mode: RagdollMode, at: f32) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    ground(&mut sim);
    let entity = human(&mut sim, detail, mode, Vec3::Y * at);
    (sim, entity)
}

/// Sets the gravity of the world, metres per second squared.
pub fn gravity(sim: &mut Sim, to: Vec3) {
    let world = sim.app.world_mut();
    let mut worlds = world.query::<&mut RapierConfiguration>();
    for mut config in worlds.iter_mut(world) {
        config.gravity = to;
    }
}

/// Swings arms and legs as at a sprint.
pub fn sprint(sim: &mut Sim, ragdoll: Entity, tick: usize) {
    let profile = sim.get::<Ragdoll>(ragdoll).profile;
    let swing = ops::sin(tick as f32 * sim.dt() * 14.0);
    let x = Quat::from_rotation_x;
    let elbow = |name: &str| {
        let axis = profile.bone(name).map_or(Quat::IDENTITY, |b| b.joint.frame) * Vec3::X;
        Quat::from_axis_angle(axis, 1.5)
    };
    let pose = RagdollPose::from_turns(
        &profile,
        [
            ("pelvis", x(-0.2)),
            ("thigh_l", x(0.5 + 0.7 * swing)),
            ("thigh_r", x(0.5 - 0.7 * swing)),
            ("shin_l", x(-0.9 + 0.7 * swing)),
            ("shin_r", x(-0.9 - 0.7 * swing)),
            ("upper_arm_l", x(-0.8 * swing)),
            ("upper_arm_r", x(0.8 * swing)),
            ("forearm_l", elbow("forearm_l")),
            ("forearm_r", elbow("forearm_r")),
        ],
    );
    insert(sim, ragdoll, pose);
}

/// A pose in which every joint is somewhere within this part of its limits, evenly.
pub fn random_pose(profile: &RagdollProfile, dice: &mut Dice, part: f32) -> RagdollPose {
    let turns: Vec<(&str, Quat)> = (profile.bones.iter())
        .map(|bone| {
            let mut within = |range: Vec2| {
                let middle = 0.5 * (range.x + range.y);
                middle + 0.5 * part * dice.roll() * (range.y - range.x)
            };
            let about = |v: Vec3| Quat::from_scaled_axis(v);
            let local = match bone.joint.kind {
                JointKind::Ball {
                    swing,
                    center,
                    twist,
                } => {
                    let twist = within(twist);
                    // Within the ellipse, not only within the box about it.
                    let y = within(Vec2::new(-swing.x, swing.x)) * core::f32::consts::FRAC_1_SQRT_2;
                    let z = within(Vec2::new(-swing.y, swing.y)) * core::f32::consts::FRAC_1_SQRT_2;
                    let center = about(Vec3::new(0.0, center.x, center.y));
                    center * about(Vec3::new(0.0, y, z)) * Quat::from_rotation_x(twist)
                }
                JointKind::Condyloid { swing, center } => {
                    let y = within(Vec2::new(-swing.x, swing.x)) * core::f32::consts::FRAC_1_SQRT_2;
                    let z = within(Vec2::new(-swing.y, swing.y)) * core::f32::consts::FRAC_1_SQRT_2;
                    about(Vec3::new(0.0, center.x, center.y)) * about(Vec3::new(0.0, y, z))
                }
                JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => {
                    Quat::from_rotation_x(within(Vec2::new(min, max)))
                }
                JointKind::Saddle { y, z } => about(Vec3::new(0.0, within(y), within(z))),
                JointKind::Gliding { .. } | JointKind::Fixed => Quat::IDENTITY,
            };
            let frame = bone.joint.frame;
            (bone.name.as_str(), frame * local * frame.inverse())
        })
        .collect();
    RagdollPose::from_turns(profile, turns)
}

/// Moves a figure on by one tick at this velocity, metres per second.
pub fn stride(sim: &mut Sim, ragdoll: Entity, velocity: Vec3) {
    let way = velocity * sim.dt();
    edit::<Transform>(sim, ragdoll, |t| t.translation += way);
    sim.ticks(1);
}

/// Hits a bone, or of a figure the nearest one.
pub fn hit(sim: &mut Sim, entity: Entity, point: Vec3, impulse: Vec3) {
    sim.app.world_mut().commands().hit(entity, point, impulse);
    sim.app.world_mut().flush();
}

/// Hits a bone at its joint.
pub fn push(sim: &mut Sim, bone: Entity, impulse: Vec3) {
    let point = sim.position(bone);
    hit(sim, bone, point, impulse);
}

/// Lets bones be simulated while the figure is [`RagdollMode::Partial`].
pub fn simulate<'a>(sim: &mut Sim, ragdoll: Entity, names: impl IntoIterator<Item = &'a str>) {
    for name in names {
        let part = bone(sim, ragdoll, name);
        edit::<BoneControl>(sim, part, |c| c.simulated = true);
    }
}

pub fn ask(sim: &mut Sim, ragdoll: Entity, mode: RagdollMode) {
    edit::<RagdollIntent>(sim, ragdoll, |intent| intent.mode = mode);
}

pub fn bones(sim: &Sim, ragdoll: Entity) -> Vec<Entity> {
    let bones = sim.app.world().get::<Bones>(ragdoll);
    bones.map(|b| b.iter().collect()).unwrap_or_default()
}

/// A level floor with its top at 0. Not that of the harness: against a box of 400 m the engine's search for
/// the nearest points of a capsule fails now and then, and the bone falls into the floor for some ticks.
pub fn ground(sim: &mut Sim) -> Entity {
    sim.block(Vec3::Y * -0.5, Vec3::new(20.0, 1.0, 20.0))
}

/// A bone by name.
pub fn bone(sim: &Sim, ragdoll: Entity, name: &str) -> Entity {
    let all = bones(sim, ragdoll);
    let found = all.iter().find(|b| sim.get::<Name>(**b).as_str() == name);
    *found.unwrap_or_else(|| panic!("no bone {name}"))
}

pub fn outputs(sim: &Sim, ragdoll: Entity) -> Vec<BoneOutput> {
    let all = bones(sim, ragdoll);
    all.iter().map(|b| sim.get::<BoneOutput>(*b)).collect()
}

/// The largest of something over all bones.
pub fn worst(sim: &Sim, ragdoll: Entity, of: impl Fn(&BoneOutput) -> f32) -> f32 {
    outputs(sim, ragdoll).iter().map(of).fold(0.0, f32::max)
}

/// Mass of each bone, kilograms, and velocity of its centre of mass.
pub fn momentum(sim: &Sim, ragdoll: Entity) -> (Vec3, f32) {
    let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
    for bone in bones(sim, ragdoll) {
        let properties = sim.get::<AdditionalMassProperties>(bone);
        let AdditionalMassProperties::MassProperties(p) = properties else {
            continue;
        };
        let (out, pose) = (sim.get::<BoneOutput>(bone), sim.get::<Transform>(bone));
        let arm = pose.rotation * p.local_center_of_mass;
        sum += (out.velocity + out.spin.cross(arm)) * p.mass;
        mass += p.mass;
    }
    (sum, mass)
}

/// Whether every bone is somewhere.
pub fn finite(sim: &Sim, ragdoll: Entity) -> bool {
    bones(sim, ragdoll).iter().all(|b| {
        let (pose, out) = (sim.get::<Transform>(*b), sim.get::<BoneOutput>(*b));
        pose.translation.is_finite()
            && pose.rotation.is_finite()
            && out.velocity.is_finite()
            && out.spin.is_finite()
    })
}

/// The same numbers in each run, evenly over −1 to 1.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn roll(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    pub fn vec(&mut self) -> Vec3 {
        Vec3::new(self.roll(), self.roll(), self.roll())
    }

    /// A direction.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vec();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// A rotation by at most this angle, radians.
    pub fn rotation(&mut self, most: f32) -> Quat {
        let (sin, cos) = ops::sin_cos(self.roll() * most * 0.5);
        let axis = self.direction() * sin;
        Quat::from_xyzw(axis.x, axis.y, axis.z, cos)
    }
}

/// Two bones: a heavy block, and an arm of 2 kg and 0.3 m that hangs from it by this joint.
pub fn arm(joint: JointProfile) -> RagdollProfile {
    let block = BoneShape::Box {
        center: Vec3::Y * 0.5,
        rotation: Quat::IDENTITY,
        half: Vec3::splat(0.2),
    };
    let rod = BoneShape::Capsule {
        from: Vec3::NEG_Y * 0.05,
        to: Vec3::NEG_Y * 0.25,
        radius: 0.05,
    };
    RagdollProfile {
        bones: vec![
            BoneProfile {
                name: "block".into(),
                mass: BoneMass::solid(2.0, &block),
                shape: block,
                ..default()
            },
            BoneProfile {
                name: "arm".into(),
                parent: Some("block".into()),
                mass: BoneMass::solid(2.0, &rod),
                shape: rod,
                joint,
                ..default()
            },
        ],
        no_contact: vec![],
    }
}

/// The [`arm`] with its joint, held at the block in this place and driven with this strength. Also the limb.
pub fn hung(hz: f64, joint: JointProfile, strength: f32, at: Transform) -> (Sim, Entity, Entity) {
    let mut sim = Sim::new(hz);
    let ragdoll = Ragdoll {
        conditioning: 0.0,
        ..Ragdoll::new(arm(joint), 4.0)
    };
    let intent = RagdollIntent {
        mode: RagdollMode::Partial,
        strength,
    };
    let entity = sim.spawn((ragdoll, intent, at));
    sim.ticks(1);
    simulate(&mut sim, entity, ["arm"]);
    let limb = bone(&sim, entity, "arm");
    (sim, entity, limb)
}

/// Axes with X pointing down, along the arm.
pub fn along_arm() -> Quat {
    Quat::from_rotation_z(-core::f32::consts::FRAC_PI_2)
}
