//! Going from station to station, and watching a station's scripted walker.

use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use bevy_egui::input::egui_wants_any_keyboard_input;
use bevy_embody::prelude::*;

use super::{
    Player,
    camera::CameraRig,
    overlay::Hud,
    player::{player, player_motor},
};
use crate::{
    course::{Course, CourseNode, despawn_course, spawn_course},
    stations::{StationResult, StationRun, stations},
};

/// Below this height, metres, nothing is left to stand on.
const ABYSS: f32 = -40.0;

/// Where the player starts.
#[derive(Resource, Clone, Debug, Default)]
pub struct Start {
    /// Name of the station, or a part of it; none starts at the first.
    pub station: Option<String>,
    /// Whether the station's scripted walker starts at once.
    pub play: bool,
}

/// The stations and which of them the player is at.
#[derive(Resource, Debug)]
pub struct Visit {
    /// Name, description and start of each, in the order of a walk.
    pub stops: Vec<Stop>,
    /// The one the player was last put at.
    pub current: usize,
}

/// A station to go to.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Its name.
    pub name: String,
    /// What it shows.
    pub describe: String,
    /// Pose of the foot, facing `-Z`.
    pub start: Transform,
}

impl Default for Visit {
    fn default() -> Self {
        let stops = stations()
            .into_iter()
            .map(|station| Stop {
                name: station.name,
                describe: station.describe,
                start: station.start,
            })
            .collect();
        Self { stops, current: 0 }
    }
}

impl Visit {
    /// The place of the station of this name, else of the first whose name contains it.
    pub fn find(&self, name: &str) -> Option<usize> {
        let exact = self.stops.iter().position(|stop| stop.name == name);
        exact.or_else(|| self.stops.iter().position(|stop| stop.name.contains(name)))
    }

    fn stop(&self) -> Option<&Stop> {
        self.stops.get(self.current)
    }
}

/// A scripted walk that the player's character does by itself.
#[derive(Resource)]
pub(super) struct Playing {
    run: StationRun,
    before: (Character, CharacterMotor),
}

/// Spawns the course and the player. Number keys and `PageUp`/`PageDown` go to a station, `R` back
/// to its start, `Shift`+`R` also puts the course back, `T` plays the station's script.
pub(super) struct VisitPlugin;

impl Plugin for VisitPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Visit>()
            .init_resource::<Start>()
            .add_systems(Startup, (begin, announce).chain())
            .add_systems(
                PostStartup,
                (face_start, play.run_if(|start: Res<Start>| start.play))
                    .chain()
                    .in_set(ReadyToWalk),
            )
            .add_systems(
                Update,
                (
                    choose,
                    reset_course.run_if(input_just_pressed(KeyCode::KeyR)),
                    play.run_if(input_just_pressed(KeyCode::KeyT)),
                    announce.run_if(resource_changed::<Visit>),
                )
                    .chain()
                    .run_if(not(egui_wants_any_keyboard_input)),
            )
            .add_systems(Update, catch_falling)
            .add_systems(FixedUpdate, advance.run_if(resource_exists::<Playing>));
    }
}

/// The player and the camera are at the start after this, in `PostStartup`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct ReadyToWalk;

/// Turns the camera to where the player looks.
fn face_start(visit: Res<Visit>, mut rigs: Query<&mut CameraRig>) {
    if let Some(stop) = visit.stop() {
        for mut rig in &mut rigs {
            rig.reset_to(&stop.start);
        }
    }
}

fn begin(mut commands: Commands, course: Res<Course>, start: Res<Start>, mut visit: ResMut<Visit>) {
    spawn_course(&mut commands, &course);
    if let Some(name) = &start.station {
        match visit.find(name) {
            Some(found) => visit.current = found,
            None => warn!("there is no station {name}; starting at the first"),
        }
    }
    let at = visit.stop().map_or(Transform::IDENTITY, |stop| stop.start);
    commands.spawn(player(at));
}

/// Which key means which of ten stations.
const DIGITS: [KeyCode; 10] = [
    KeyCode::Digit1,
    KeyCode::Digit2,
    KeyCode::Digit3,
    KeyCode::Digit4,
    KeyCode::Digit5,
    KeyCode::Digit6,
    KeyCode::Digit7,
    KeyCode::Digit8,
    KeyCode::Digit9,
    KeyCode::Digit0,
];

/// The station that the keys ask for, if they ask for one.
fn asked(keys: &ButtonInput<KeyCode>, current: usize, count: usize) -> Option<usize> {
    if count == 0 {
        return None;
    }
    if keys.just_pressed(KeyCode::PageDown) {
        return Some((current + 1) % count);
    }
    if keys.just_pressed(KeyCode::PageUp) {
        return Some((current + count - 1) % count);
    }
    if keys.just_pressed(KeyCode::KeyR) {
        return Some(current);
    }
    // With Shift the second ten, with Alt the third.
    let tens = if keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]) {
        10
    } else if keys.any_pressed([KeyCode::AltLeft, KeyCode::AltRight]) {
        20
    } else {
        0
    };
    let digit = DIGITS.iter().position(|key| keys.just_pressed(*key))?;
    Some(tens + digit).filter(|station| *station < count)
}

fn choose(
    keys: Res<ButtonInput<KeyCode>>,
    mut visit: ResMut<Visit>,
    mut commands: Commands,
    playing: Option<Res<Playing>>,
    mut players: Query<(Entity, &mut Transform, &mut CharacterState), With<Player>>,
    mut rigs: Query<&mut CameraRig>,
) {
    let Some(next) = asked(&keys, visit.current, visit.stops.len()) else {
        return;
    };
    visit.current = next;
    let Some(stop) = visit.stop() else {
        return;
    };
    for (entity, mut transform, mut state) in &mut players {
        if let Some(playing) = &playing {
            commands.entity(entity).insert(playing.before.clone());
            commands.remove_resource::<Playing>();
        }
        *transform = stop.start;
        *state = CharacterState::default();
    }
    for mut rig in &mut rigs {
        rig.reset_to(&stop.start);
    }
}

fn reset_course(
    keys: Res<ButtonInput<KeyCode>>,
    mut commands: Commands,
    course: Res<Course>,
    nodes: Query<Entity, With<CourseNode>>,
) {
    if keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]) {
        despawn_course(&mut commands, &nodes);
        spawn_course(&mut commands, &course);
    }
}

fn catch_falling(
    visit: Res<Visit>,
    mut players: Query<(&mut Transform, &mut CharacterState), With<Player>>,
) {
    for (mut transform, mut state) in &mut players {
        if transform.translation.y < ABYSS
            && let Some(stop) = visit.stop()
        {
            *transform = stop.start;
            *state = CharacterState::default();
        }
    }
}

/// Starts the script of the current station with the player as its walker, or stops it.
fn play(world: &mut World) {
    if let Some(playing) = world.remove_resource::<Playing>() {
        if let Ok(mut walker) = world.get_entity_mut(playing.run.walker()) {
            walker.insert(playing.before);
        }
        return;
    }
    let current = world.resource::<Visit>().current;
    let Some(station) = stations().into_iter().nth(current) else {
        return;
    };
    let mut players = world.query_filtered::<(Entity, &Character, &CharacterMotor), With<Player>>();
    let Ok((walker, character, motor)) = players.single(world) else {
        return;
    };
    let before = (character.clone(), motor.clone());
    let (start, motor) = (station.start, player_motor(&station.motor));
    let run = StationRun::with(world, station, walker);
    world.entity_mut(walker).insert(motor);
    let mut rigs = world.query::<&mut CameraRig>();
    for mut rig in rigs.iter_mut(world) {
        rig.reset_to(&start);
    }
    world.insert_resource(Playing { run, before });
}

/// Plays one tick; at the end tells what came of it and gives the keys back.
fn advance(world: &mut World) {
    let done = world.resource_scope(|world, mut playing: Mut<Playing>| {
        let done = playing.run.tick(world);
        let text = if done {
            verdict(&playing.run.result())
        } else {
            playing
                .run
                .current()
                .map_or_else(String::new, |step| format!("plays: {}", step.describe()))
        };
        let mut hud = world.resource_mut::<Hud>();
        if hud.detail != text {
            hud.detail = text;
        }
        done
    });
    if done {
        play(world);
    }
}

fn verdict(result: &StationResult) -> String {
    let mut text = format!(
        "{} after {:.1} s\n",
        if result.passed() { "passed" } else { "FAILED" },
        result.seconds
    );
    for check in &result.checks {
        let mark = if check.pass { "ok" } else { "FAIL" };
        text.push_str(&format!("{mark}: {}: {}\n", check.asked, check.got));
    }
    text
}

fn announce(visit: Res<Visit>, mut hud: ResMut<Hud>) {
    if let Some(stop) = visit.stop() {
        hud.title = format!("{}/{}  {}", visit.current + 1, visit.stops.len(), stop.name);
        hud.detail.clone_from(&stop.describe);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_go_round_the_stations_and_never_beyond() {
        let press = |key| {
            let mut keys = ButtonInput::default();
            keys.press(key);
            keys
        };
        assert_eq!(asked(&press(KeyCode::PageDown), 4, 5), Some(0));
        assert_eq!(asked(&press(KeyCode::PageUp), 0, 5), Some(4));
        assert_eq!(asked(&press(KeyCode::Digit1), 3, 5), Some(0));
        assert_eq!(asked(&press(KeyCode::Digit9), 3, 5), None);
        assert_eq!(asked(&press(KeyCode::PageDown), 0, 0), None);
        let mut keys = press(KeyCode::ShiftLeft);
        keys.press(KeyCode::Digit2);
        assert_eq!(asked(&keys, 0, 20), Some(11));
    }
}
