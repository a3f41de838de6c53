//! What became of figures, tick by tick, in the station's axes.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

use super::{larger, script::Crew, stage::Block};
use crate::{
    course::layout::Place,
    stations::{OfStep, Trace},
};

/// One figure after a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fallen {
    /// Its pelvis.
    pub root: Vec3,
    /// Its head.
    pub head: Vec3,
    /// Its entity: on the ground below it.
    pub foot: Vec3,
    /// Newton-seconds.
    pub momentum: Vec3,
    /// Kilograms.
    pub mass: f32,
    /// The widest gap of its simulated joints, and the mean, metres.
    pub gap: [f32; 2],
    /// Speed of its fastest bone, metres per second.
    pub fastest: f32,
    /// How deep a simulated bone is in something fixed, metres; of the deepest.
    pub sunk: f32,
    /// Bones that are simulated, and those of them that are awake.
    pub simulated: [usize; 2],
    /// Angle between its joints and the pose asked for, radians: the largest, and their mean.
    pub error: [f32; 2],
    /// What its bones are.
    pub mode: RagdollMode,
    /// Whether it stands, if it is a person.
    pub phase: BodyPhase,
}

impl Fallen {
    /// Velocity of its centre of mass, metres per second.
    pub fn velocity(&self) -> Vec3 {
        self.momentum / self.mass
    }
}

/// All of them after a tick.
#[derive(Clone, Debug)]
pub struct FallSample {
    /// The step of the script that the tick belonged to.
    pub step: usize,
    /// Seconds since the start.
    pub time: f64,
    /// The figures.
    pub figures: Vec<Fallen>,
    /// The crates.
    pub props: Vec<Vec3>,
    /// The vehicle, and its speed ahead, metres per second.
    pub car: Option<(Transform, f32)>,
}

impl OfStep for FallSample {
    fn step(&self) -> usize {
        self.step
    }

    fn time(&self) -> f64 {
        self.time
    }
}

/// All samples of a falling station.
pub type FallTrace = Trace<FallSample>;

/// Looks at all of them.
pub fn sample(world: &World, crew: &Crew, place: &Place, ground: &[Block]) -> FallSample {
    let at = |entity: &Entity| {
        let pose = world.get::<Transform>(*entity);
        pose.map_or(Vec3::NAN, |pose| place.local_point(pose.translation))
    };
    let car = crew.car.and_then(|car| {
        let pose = place.local_pose(world.get::<Transform>(car)?);
        Some((pose, world.get::<VehicleTelemetry>(car)?.speed))
    });
    FallSample {
        step: 0,
        time: 0.0,
        figures: (crew.figures.iter())
            .map(|figure| {
                // Who cannot be read is nowhere, which ends the run.
                fallen(world, *figure, place, ground).unwrap_or(Fallen {
                    root: Vec3::NAN,
                    ..default()
                })
            })
            .collect(),
        props: crew.props.iter().map(at).collect(),
        car,
    }
}

fn fallen(world: &World, figure: Entity, place: &Place, ground: &[Block]) -> Option<Fallen> {
    let profile = &world.get::<Ragdoll>(figure)?.profile;
    let mut seen = Fallen {
        foot: place.local_point(world.get::<Transform>(figure)?.translation),
        mode: world.get::<RagdollState>(figure)?.mode,
        sunk: f32::MIN,
        ..default()
    };
    if let Some(state) = world.get::<CharacterRagdollState>(figure) {
        seen.phase = state.phase;
    }
    let bones = world.get::<Bones>(figure)?;
    let mut count = 0.0;
    for entity in bones.iter() {
        let bone = world.get::<RagdollBone>(entity)?;
        let profile = profile.bones.get(bone.index)?;
        let (pose, output) = (
            world.get::<Transform>(entity)?,
            world.get::<BoneOutput>(entity)?,
        );
        match profile.name.as_str() {
            "pelvis" => seen.root = place.local_point(pose.translation),
            "head" => seen.head = place.local_point(pose.translation),
            _ => {}
        }
        if let Some(AdditionalMassProperties::MassProperties(p)) = world.get(entity) {
            let arm = pose.rotation * p.local_center_of_mass;
            let velocity = output.velocity + output.spin.cross(arm);
            seen.momentum += place.local_direction(velocity) * p.mass;
            seen.mass += p.mass;
        }
        // A skeleton has more joints in its spine than a figure has bodies: what follows it may part.
        let gap = if output.simulated { output.gap } else { 0.0 };
        seen.gap = [larger(seen.gap[0], gap), seen.gap[1] + gap];
        seen.fastest = larger(seen.fastest, output.velocity.length());
        seen.error = [
            larger(seen.error[0], output.error),
            seen.error[1] + output.error,
        ];
        seen.simulated[0] += usize::from(output.simulated);
        seen.simulated[1] += usize::from(output.simulated && !output.asleep);
        // An animation may have its feet anywhere.
        let touches = balls(&profile.shape).filter(|_| output.simulated);
        for (point, radius) in touches {
            let point = pose.transform_point(point);
            for block in ground {
                seen.sunk = larger(seen.sunk, block.depth(point, radius));
            }
        }
        count += 1.0;
    }
    seen.gap[1] /= count;
    seen.error[1] /= count;
    Some(seen)
}

/// Balls inside a bone's shape that touch its surface where it touches the ground.
fn balls(shape: &BoneShape) -> impl Iterator<Item = (Vec3, f32)> + use<> {
    let (points, radius) = match *shape {
        BoneShape::Capsule { from, to, radius } => (
            [0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0].map(|part| from.lerp(to, part)),
            radius,
        ),
        BoneShape::Box {
            center,
            rotation,
            half,
        } => {
            let corner = |i: usize| {
                let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
                center + rotation * (half * Vec3::new(sign(1), sign(2), sign(4)))
            };
            (core::array::from_fn(corner), 0.0)
        }
    };
    points.into_iter().map(move |point| (point, radius))
}
