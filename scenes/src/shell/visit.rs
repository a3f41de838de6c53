//! Going from station to station, and watching a station's scripted walker.

use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use bevy_egui::input::egui_wants_any_keyboard_input;
use bevy_embody::prelude::*;

use super::{
    Garage, Player,
    camera::CameraRig,
    garage,
    overlay::Hud,
    player::{player, player_motor},
};
use crate::{
    course::{Course, CourseNode, despawn_course, spawn_course},
    driving::{DriveRun, DriveStep, drive_stations},
    stations::{StationResult, StationRun, Step, stations},
};

/// Below this height, metres, nothing is left to stand on.
const ABYSS: f32 = -40.0;

/// Where the player starts.
#[derive(Resource, Clone, Debug, Default)]
pub struct Start {
    /// Name of the station, or a part of it; none starts at the first.
    pub station: Option<String>,
    /// Name of the vehicle to drive, or a part of it.
    pub vehicle: Option<String>,
    /// Whether the station's scripted walker or driver starts at once.
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
    /// Pose of the foot, or of the ground below the vehicle, facing `-Z`.
    pub start: Transform,
    /// Whether one drives there.
    pub drive: bool,
}

impl Default for Visit {
    fn default() -> Self {
        let stops = stations()
            .into_iter()
            .map(|station| Stop {
                name: station.name,
                describe: station.describe,
                start: station.start,
                drive: false,
            })
            .chain(drive_stations().into_iter().map(|station| Stop {
                start: station.start(),
                name: station.name,
                describe: station.describe,
                drive: true,
            }))
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

/// A script that the player's character or vehicle does by itself.
#[derive(Resource)]
pub(super) enum Playing {
    /// A walk, and what the walker was before.
    Walk(Box<StationRun>, Box<(Character, CharacterMotor)>),
    /// A drive.
    Drive(Box<DriveRun>),
}

impl Playing {
    fn tick(&mut self, world: &mut World) -> bool {
        match self {
            Self::Walk(run, _) => run.tick(world),
            Self::Drive(run) => run.tick(world),
        }
    }

    fn current(&self) -> Option<String> {
        match self {
            Self::Walk(run, _) => run.current().map(Step::describe),
            Self::Drive(run) => run.current().map(DriveStep::describe),
        }
    }

    fn result(&self) -> StationResult {
        match self {
            Self::Walk(run, _) => run.result(),
            Self::Drive(run) => run.result(),
        }
    }
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

fn begin(
    mut commands: Commands,
    course: Res<Course>,
    start: Res<Start>,
    mut garage: ResMut<Garage>,
    mut visit: ResMut<Visit>,
) {
    spawn_course(&mut commands, &course);
    if let Some(name) = &start.vehicle {
        garage.choose(name);
    }
    if let Some(name) = &start.station {
        match visit.find(name) {
            Some(found) => visit.current = found,
            None => warn!("there is no station {name}; starting at the first"),
        }
    }
    let (at, drive) = visit.stop().map_or((Transform::IDENTITY, false), |stop| {
        (stop.start, stop.drive)
    });
    if drive {
        commands.queue(move |world: &mut World| garage::drive(world, at));
    } else {
        commands.spawn(player(at));
    }
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
    // With Shift the second ten, with Alt the third, with both the fourth.
    let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let alt = keys.any_pressed([KeyCode::AltLeft, KeyCode::AltRight]);
    let tens = 10 * usize::from(shift) + 20 * usize::from(alt);
    let digit = DIGITS.iter().position(|key| keys.just_pressed(*key))?;
    Some(tens + digit).filter(|station| *station < count)
}

fn choose(world: &mut World) {
    let visit = world.resource::<Visit>();
    let keys = world.resource::<ButtonInput<KeyCode>>();
    if let Some(next) = asked(keys, visit.current, visit.stops.len()) {
        go(world, next);
    }
}

/// Puts the player at a stop, on foot or at the wheel.
fn go(world: &mut World, next: usize) {
    stop_playing(world);
    let mut visit = world.resource_mut::<Visit>();
    visit.current = next;
    let Some(stop) = visit.stop().cloned() else {
        return;
    };
    if stop.drive {
        garage::drive(world, stop.start);
    } else {
        garage::stand(world, stop.start);
    }
    look_from(world, &stop.start);
}

fn look_from(world: &mut World, start: &Transform) {
    let mut rigs = world.query::<&mut CameraRig>();
    for mut rig in rigs.iter_mut(world) {
        rig.reset_to(start);
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
    mut commands: Commands,
    players: Query<&Transform, With<Player>>,
) {
    if players.iter().any(|at| at.translation.y < ABYSS) {
        let current = visit.current;
        commands.queue(move |world: &mut World| go(world, current));
    }
}

/// Stops the script, if one is playing, and gives the controls back.
pub(super) fn stop_playing(world: &mut World) -> bool {
    match world.remove_resource::<Playing>() {
        Some(Playing::Walk(run, before)) => {
            if let Ok(mut walker) = world.get_entity_mut(run.walker()) {
                walker.insert(*before);
            }
            true
        }
        Some(Playing::Drive(_)) => true,
        None => false,
    }
}

/// Starts the script of the current station with the player, or stops it.
fn play(world: &mut World) {
    if stop_playing(world) {
        return;
    }
    let current = world.resource::<Visit>().current;
    let walks = stations().len();
    let playing = if current < walks {
        play_walk(world, current)
    } else {
        play_drive(world, current - walks)
    };
    if let Some(playing) = playing {
        world.insert_resource(playing);
    }
}

fn play_walk(world: &mut World, place: usize) -> Option<Playing> {
    let station = stations().into_iter().nth(place)?;
    garage::stand(world, station.start);
    let mut players = world.query_filtered::<(Entity, &Character, &CharacterMotor), With<Player>>();
    let (walker, character, motor) = players.single(world).ok()?;
    let before = Box::new((character.clone(), motor.clone()));
    let (start, motor) = (station.start, player_motor(&station.motor));
    let run = StationRun::with(world, station, walker);
    world.entity_mut(walker).insert(motor);
    look_from(world, &start);
    Some(Playing::Walk(Box::new(run), before))
}

fn play_drive(world: &mut World, place: usize) -> Option<Playing> {
    let station = drive_stations().into_iter().nth(place)?;
    let figures = world.resource::<Garage>().figures();
    if let Err(why) = station.plan(&figures) {
        world.resource_mut::<Hud>().detail = format!("not for the {}: {why}", figures.name);
        return None;
    }
    let start = station.start();
    garage::drive(world, start);
    let (vehicle, _) = garage::driver(world)?;
    let run = DriveRun::with(world, station, figures, vehicle)?;
    look_from(world, &start);
    Some(Playing::Drive(Box::new(run)))
}

/// Plays one tick; at the end tells what came of it and gives the keys back.
fn advance(world: &mut World) {
    let done = world.resource_scope(|world, mut playing: Mut<Playing>| {
        let done = playing.tick(world);
        let text = if done {
            verdict(&playing.result())
        } else {
            playing
                .current()
                .map_or_else(String::new, |step| format!("plays: {step}"))
        };
        let mut hud = world.resource_mut::<Hud>();
        if hud.detail != text {
            hud.detail = text;
        }
        done
    });
    if done {
        stop_playing(world);
    }
}

/// Writes which vehicle is driven, behind the place.
pub(super) fn announce_vehicle(world: &mut World) {
    world.resource_mut::<Visit>().set_changed();
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

fn announce(
    visit: Res<Visit>,
    garage: Res<Garage>,
    driving: Query<(), (With<Player>, With<Vehicle>)>,
    mut hud: ResMut<Hud>,
) {
    if let Some(stop) = visit.stop() {
        hud.title = format!("{}/{}  {}", visit.current + 1, visit.stops.len(), stop.name);
        if stop.drive || !driving.is_empty() {
            let help = if garage.assists { "" } else { ", no helpers" };
            hud.title
                .push_str(&format!("  ({}{help})", garage.figures().name));
        }
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
