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
    stops::{Visit, asked},
};
use crate::{
    course::{Course, CourseNode, despawn_course, spawn_course},
    driving::{DriveRun, DriveStep, drive_stations},
    falling::{FallRun, FallStep, fall_stations, spawn_yard},
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

/// A script that the player's character or vehicle does by itself.
#[derive(Resource)]
pub(super) enum Playing {
    /// A walk, and what the walker was before.
    Walk(Box<StationRun>, Box<(Character, CharacterMotor)>),
    /// A drive.
    Drive(Box<DriveRun>),
    /// A fall.
    Fall(Box<FallRun>),
}

/// Those who are at the falling station that the player is at, before and after the script.
#[derive(Resource)]
struct Lying(Box<FallRun>);

impl Playing {
    /// Whether the player's own character or vehicle is busy.
    pub(super) fn takes_player(playing: Option<Res<Self>>) -> bool {
        playing.is_some_and(|playing| !matches!(*playing, Self::Fall(_)))
    }

    fn tick(&mut self, world: &mut World) -> bool {
        match self {
            Self::Walk(run, _) => run.tick(world),
            Self::Drive(run) => run.tick(world),
            Self::Fall(run) => run.tick(world),
        }
    }

    fn current(&self) -> Option<String> {
        match self {
            Self::Walk(run, _) => run.current().map(Step::describe),
            Self::Drive(run) => run.current().map(DriveStep::describe),
            Self::Fall(run) => run.current().map(|step: &FallStep| step.describe.clone()),
        }
    }

    fn result(&self) -> StationResult {
        match self {
            Self::Walk(run, _) => run.result(),
            Self::Drive(run) => run.result(),
            Self::Fall(run) => run.result(),
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
    commands.queue(|world: &mut World| spawn_yard(world, &fall_stations()));
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
    clear(world);
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
    // Without its people there is nothing there.
    let first = stations().len() + drive_stations().len();
    if next >= first
        && let Some(playing) = play_fall(world, next - first)
    {
        world.insert_resource(playing);
    }
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
        Some(Playing::Fall(run)) => {
            // They stay as they are, for the player to push.
            clear(world);
            world.insert_resource(Lying(run));
            true
        }
        None => false,
    }
}

/// Sends away those of the falling station.
fn clear(world: &mut World) {
    if let Some(Lying(run)) = world.remove_resource::<Lying>() {
        run.end(world);
    }
}

/// Starts the script of the current station with the player, or stops it.
fn play(world: &mut World) {
    if stop_playing(world) {
        return;
    }
    let current = world.resource::<Visit>().current;
    let (walks, drives) = (stations().len(), drive_stations().len());
    let playing = if current < walks {
        play_walk(world, current)
    } else if current < walks + drives {
        play_drive(world, current - walks)
    } else {
        play_fall(world, current - walks - drives)
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

fn play_fall(world: &mut World, place: usize) -> Option<Playing> {
    let station = fall_stations().into_iter().nth(place)?;
    clear(world);
    let start = station.start();
    garage::stand(world, start);
    let run = FallRun::begin(world, station);
    look_from(world, &start);
    Some(Playing::Fall(Box::new(run)))
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
