//! The names of the stations, floating over where they start.

use bevy::{prelude::*, ui::UiSystems};

use super::{camera::CameraRig, visit::Visit};

/// How far a name can be read, metres, and over how many of them it fades.
const READ: f32 = 70.0;
const FADE: f32 = 15.0;
/// Height over the start, metres.
const OVER: f32 = 2.9;

/// The place of a name in [`Visit::stops`].
#[derive(Component)]
struct Label(usize);

/// Shows the name of every station that is near enough.
pub(super) struct LabelsPlugin;

impl Plugin for LabelsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, spawn).add_systems(
            PostUpdate,
            place
                .after(TransformSystems::Propagate)
                .before(UiSystems::Layout),
        );
    }
}

fn spawn(mut commands: Commands, visit: Res<Visit>) {
    for (index, stop) in visit.stops.iter().enumerate() {
        commands.spawn((
            Label(index),
            Text::new(stop.name.clone()),
            TextFont::from_font_size(13.0),
            TextLayout::justify(Justify::Center),
            TextColor(Color::WHITE),
            TextShadow {
                offset: Vec2::splat(1.0),
                color: Color::BLACK.with_alpha(0.7),
            },
            Node {
                position_type: PositionType::Absolute,
                width: px(160.0),
                ..default()
            },
            Visibility::Hidden,
        ));
    }
}

fn place(
    visit: Res<Visit>,
    cameras: Query<(&Camera, &GlobalTransform), With<CameraRig>>,
    mut labels: Query<(&Label, &mut Node, &mut TextColor, &mut Visibility)>,
) {
    let Ok((camera, eye)) = cameras.single() else {
        return;
    };
    for (label, mut node, mut color, mut visibility) in &mut labels {
        let Some(stop) = visit.stops.get(label.0) else {
            continue;
        };
        let over = stop.start.translation + stop.start.up() * OVER;
        let distance = over.distance(eye.translation());
        let seen = camera
            .world_to_viewport(eye, over)
            .ok()
            .filter(|_| distance < READ);
        let Some(at) = seen else {
            visibility.set_if_neq(Visibility::Hidden);
            continue;
        };
        visibility.set_if_neq(Visibility::Inherited);
        node.left = px(at.x - 80.0);
        node.top = px(at.y - 8.0);
        color.0.set_alpha(((READ - distance) / FADE).clamp(0.0, 1.0));
    }
}
