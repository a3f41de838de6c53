//! The vehicles: choosing one, getting in and out, putting it back on its wheels.

use bevy::{input::common_conditions::input_just_pressed, math::ops, prelude::*};
use bevy_egui::input::egui_wants_any_keyboard_input;
use bevy_embody::prelude::*;

use super::{
    ModelOf, Player,
    camera::{CameraRig, Seat},
    player::player,
    visit,
};
use crate::driving::{Figures, place, spawn_vehicle};

/// How near to a vehicle one must stand to get in, metres.
const REACH: f32 = 4.5;

/// The presets, and which of them the player drives.
#[derive(Resource, Clone, Debug)]
pub struct Garage {
    /// Every preset.
    pub all: Vec<Figures>,
    /// The one that is driven.
    pub chosen: usize,
    /// Whether the vehicle helps its driver: anti-lock brakes, traction and stability control.
    pub assists: bool,
}

impl Default for Garage {
    fn default() -> Self {
        Self {
            all: Figures::all(),
            chosen: 1,
            assists: true,
        }
    }
}

impl Garage {
    /// Chooses the preset of this name, else the first whose name contains it.
    pub fn choose(&mut self, name: &str) {
        let exact = self.all.iter().position(|figures| figures.name == name);
        match exact.or_else(|| self.all.iter().position(|f| f.name.contains(name))) {
            Some(found) => self.chosen = found,
            None => warn!("there is no vehicle {name}"),
        }
    }

    /// What is driven.
    pub fn figures(&self) -> Figures {
        self.all[self.chosen.min(self.all.len() - 1)].clone()
    }
}

/// `N` takes the next vehicle, `E` gets in and out, `U` puts it upright, `X` switches the helpers.
pub(super) struct GaragePlugin;

impl Plugin for GaragePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Garage>().add_systems(
            Update,
            (
                next.run_if(input_just_pressed(KeyCode::KeyN)),
                get_in_or_out.run_if(input_just_pressed(KeyCode::KeyE)),
                upright.run_if(input_just_pressed(KeyCode::KeyU)),
                switch_assists.run_if(input_just_pressed(KeyCode::KeyX)),
            )
                .chain()
                .run_if(not(egui_wants_any_keyboard_input)),
        );
    }
}

/// The entity that the player is, and whether it is a vehicle.
pub(super) fn driver(world: &mut World) -> Option<(Entity, bool)> {
    let mut players = world.query_filtered::<(Entity, Has<Vehicle>), With<Player>>();
    players.iter(world).next()
}

/// Puts the player on foot at this pose.
pub(super) fn stand(world: &mut World, at: Transform) {
    if let Some((entity, driving)) = driver(world) {
        if !driving {
            if let Ok(mut walker) = world.get_entity_mut(entity) {
                walker.insert((at, CharacterState::default()));
            }
            return;
        }
        world.despawn(entity);
    }
    world.spawn(player(at));
}

/// Puts the player at the wheel of the chosen vehicle at this pose.
pub(super) fn drive(world: &mut World, at: Transform) {
    let figures = world.resource::<Garage>().figures();
    if let Some((entity, _)) = driver(world) {
        if world.get::<ModelOf>(entity) == Some(&ModelOf(figures.name)) {
            place(world, entity, at);
            return;
        }
        world.despawn(entity);
    }
    let vehicle = spawn(world, &figures, at);
    world.entity_mut(vehicle).insert(Player);
    set_assists(world, vehicle);
}

fn spawn(world: &mut World, figures: &Figures, at: Transform) -> Entity {
    let vehicle = spawn_vehicle(&mut world.commands(), figures, at);
    world.flush();
    world.entity_mut(vehicle).insert((
        Visibility::default(),
        Interpolated,
        Seat::of(figures),
        ModelOf(figures.name),
    ));
    vehicle
}

/// The same place with the nose level and the wheels down, a little above the ground.
fn level(at: &Transform) -> Transform {
    let ahead = at.forward();
    let flat = Vec3::new(ahead.x, 0.0, ahead.z).normalize_or(Vec3::NEG_Z);
    Transform::from_translation(at.translation + Vec3::Y * 0.4).looking_to(flat, Vec3::Y)
}

fn next(world: &mut World) {
    let back = world
        .resource::<ButtonInput<KeyCode>>()
        .any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let mut garage = world.resource_mut::<Garage>();
    let count = garage.all.len();
    garage.chosen = (garage.chosen + if back { count - 1 } else { 1 }) % count;
    visit::stop_playing(world);
    if let Some((entity, true)) = driver(world)
        && let Some(at) = world.get::<Transform>(entity).copied()
    {
        drive(world, level(&at));
    }
    visit::announce_vehicle(world);
}

fn get_in_or_out(world: &mut World) {
    visit::stop_playing(world);
    let Some((entity, driving)) = driver(world) else {
        return;
    };
    let Some(at) = world.get::<Transform>(entity).copied() else {
        return;
    };
    if driving {
        // It stays where it is, with its hand brake on.
        let figures = world.resource::<Garage>().figures();
        world.despawn(entity);
        let parked = spawn(world, &figures, at);
        if let Some(mut intent) = world.get_mut::<VehicleIntent>(parked) {
            intent.handbrake = 1.0;
        }
        let aside = 0.5 * figures.preset.hull.x + 0.7;
        let foot = level(&at);
        let door =
            Transform::from_translation(foot.translation + foot.left() * aside + Vec3::Y * 0.3)
                .with_rotation(foot.rotation);
        stand(world, door);
        return;
    }
    let mut parked = world.query_filtered::<(Entity, &Transform, &ModelOf), Without<Player>>();
    let nearest = parked
        .iter(world)
        .map(|(vehicle, pose, model)| {
            (
                pose.translation.distance(at.translation),
                vehicle,
                *pose,
                model.0,
            )
        })
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((distance, vehicle, pose, name)) if distance < REACH => {
            world.despawn(vehicle);
            world.resource_mut::<Garage>().choose(name);
            drive(world, pose);
        }
        // None is near, so the chosen one comes to where the player stands.
        _ => drive(world, level(&at)),
    }
    let mut rigs = world.query::<&mut CameraRig>();
    for mut rig in rigs.iter_mut(world) {
        rig.eye = 0.0;
    }
    visit::announce_vehicle(world);
}

fn upright(world: &mut World) {
    if let Some((entity, true)) = driver(world)
        && let Some(at) = world.get::<Transform>(entity).copied()
    {
        place(world, entity, level(&at));
    }
}

fn switch_assists(world: &mut World) {
    let mut garage = world.resource_mut::<Garage>();
    garage.assists = !garage.assists;
    if let Some((entity, true)) = driver(world) {
        set_assists(world, entity);
    }
    visit::announce_vehicle(world);
}

fn set_assists(world: &mut World, vehicle: Entity) {
    let on = world.resource::<Garage>().assists;
    let wheels = world.get::<Wheels>(vehicle).map_or(0, |w| w.iter().count());
    let Ok(mut entity) = world.get_entity_mut(vehicle) else {
        return;
    };
    if on {
        entity.insert((
            AntiLockBrakes::default(),
            TractionControl { slip: 0.2 },
            HillHold::default(),
        ));
        if wheels == 4 {
            entity.insert(StabilityControl {
                tolerance: 0.15,
                ..default()
            });
        }
    } else {
        entity.remove::<(AntiLockBrakes, TractionControl, StabilityControl, HillHold)>();
    }
}

impl Seat {
    /// The seat of a preset.
    pub fn of(figures: &Figures) -> Self {
        let (size, middle) = (figures.preset.hull, figures.preset.hull_center);
        let top = middle.y + 0.5 * size.y;
        let short = size.z < 3.0;
        Self {
            target: Vec3::Y * (top * 0.85 + 0.2),
            // Above the bonnet, or where a head is on what has none.
            eyes: if short {
                Vec3::new(0.0, top.max(1.0) + 0.25, -0.1)
            } else {
                Vec3::new(0.0, top + 0.1, middle.z - 0.22 * size.z)
            },
            distance: 2.2 + 1.15 * ops::hypot(size.z, size.y),
        }
    }
}
