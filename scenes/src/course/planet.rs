//! Planets: gravity and up of a character that is near one.

use bevy::prelude::*;
use bevy_embody::prelude::*;

/// On a round body: characters within its reach fall towards it and stand on it.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Planet {
    /// Gravity towards its origin, metres per second squared.
    pub gravity: f32,
    /// Distance from its origin within which it acts, metres.
    pub reach: f32,
}

/// On a character that a [`Planet`] holds: what to give back when it leaves.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct OnPlanet {
    /// The planet.
    pub planet: Entity,
    gravity_before: Option<f32>,
    up_before: Option<CharacterUp>,
}

pub(super) struct PlanetPlugin;

impl Plugin for PlanetPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(FixedUpdate, (arrive, leave));
    }
}

fn arrive(
    mut commands: Commands,
    planets: Query<(Entity, &Planet, &Transform)>,
    mut characters: Query<
        (
            Entity,
            &mut CharacterMotor,
            &Transform,
            Option<&CharacterUp>,
        ),
        Without<OnPlanet>,
    >,
) {
    for (planet_entity, planet, place) in &planets {
        for (character, mut motor, transform, up) in &mut characters {
            if transform.translation.distance(place.translation) >= planet.reach {
                continue;
            }
            let on_planet = OnPlanet {
                planet: planet_entity,
                gravity_before: motor.gravity,
                up_before: up.copied(),
            };
            motor.gravity = Some(planet.gravity);
            commands.entity(character).insert((
                on_planet,
                CharacterUp {
                    direction: UpDirection::AwayFrom(place.translation),
                    ..up.copied().unwrap_or_default()
                },
            ));
        }
    }
}

fn leave(
    mut commands: Commands,
    planets: Query<(&Planet, &Transform)>,
    mut characters: Query<(Entity, &mut CharacterMotor, &Transform, &OnPlanet)>,
) {
    for (character, mut motor, transform, on_planet) in &mut characters {
        let held = planets.get(on_planet.planet).is_ok_and(|(planet, place)| {
            transform.translation.distance(place.translation) < planet.reach
        });
        if held {
            continue;
        }
        motor.gravity = on_planet.gravity_before;
        // Without the component up stays where it was, so the world's own is asked for.
        commands
            .entity(character)
            .remove::<OnPlanet>()
            .insert(on_planet.up_before.unwrap_or_default());
    }
}
