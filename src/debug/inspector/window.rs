//! The frame of a window: what it is called, who is shown, and the scrolled inside.

use bevy::prelude::*;
use bevy_egui::egui::{self, ScrollArea, Ui};

use super::{InspectorPanel, pick};

/// Whom a window is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Subject {
    Character,
    #[cfg(feature = "vehicle")]
    Vehicle,
    #[cfg(feature = "ragdoll")]
    Ragdoll,
}

impl Subject {
    fn title(self) -> &'static str {
        match self {
            Self::Character => "Character",
            #[cfg(feature = "vehicle")]
            Self::Vehicle => "Vehicle",
            #[cfg(feature = "ragdoll")]
            Self::Ragdoll => "Ragdoll",
        }
    }

    fn nobody(self) -> &'static str {
        match self {
            Self::Character => "there is no character",
            #[cfg(feature = "vehicle")]
            Self::Vehicle => "there is no vehicle",
            #[cfg(feature = "ragdoll")]
            Self::Ragdoll => "there is no ragdoll",
        }
    }

    fn chosen(self, panel: &mut InspectorPanel) -> &mut Option<Entity> {
        match self {
            Self::Character => &mut panel.character,
            #[cfg(feature = "vehicle")]
            Self::Vehicle => &mut panel.vehicle,
            #[cfg(feature = "ragdoll")]
            Self::Ragdoll => &mut panel.ragdoll,
        }
    }
}

/// What an entity is called in the panel.
pub(super) fn name(names: &Query<&Name>, entity: Entity) -> String {
    names
        .get(entity)
        .map_or_else(|_| entity.to_string(), ToString::to_string)
}

/// Shows a window with a choice among `all`, and in it `inside` for the one that is chosen. The
/// second argument of `inside` is how far back plots reach, seconds.
pub(super) fn show<D>(
    context: &egui::Context,
    panel: &mut ResMut<InspectorPanel>,
    subject: Subject,
    all: impl Iterator<Item = (Entity, D)>,
    names: &Query<&Name>,
    inside: impl FnOnce(&mut Ui, f64, Entity, D),
) {
    // What has not changed must not look changed.
    let mut next = panel.clone();
    let InspectorPanel { seconds, .. } = next;
    let mut open = next.open;
    let chosen = subject.chosen(&mut next);
    let before = *chosen;
    egui::Window::new(subject.title())
        .id(egui::Id::new(("embody", subject.title())))
        .open(&mut open)
        .default_pos([16.0, 16.0])
        .default_width(340.0)
        .default_height(500.0)
        .show(context, |ui| {
            let mut all: Vec<(Entity, D)> = all.collect();
            all.sort_unstable_by_key(|(entity, _)| *entity);
            if all.len() > 1 {
                choose(ui, chosen, all.iter().map(|(entity, _)| *entity), names);
            }
            match pick(*chosen, all.into_iter()) {
                Some((entity, shown)) => {
                    ScrollArea::vertical()
                        .auto_shrink(false)
                        .show(ui, |ui| inside(ui, seconds, entity, shown));
                }
                None => {
                    ui.weak(subject.nobody());
                }
            }
        });
    if *chosen != before || open != panel.open {
        next.open = open;
        **panel = next;
    }
}

/// A list to choose from.
fn choose(
    ui: &mut Ui,
    chosen: &mut Option<Entity>,
    mut all: impl Iterator<Item = Entity> + Clone,
    names: &Query<&Name>,
) {
    let shown = chosen.or(all.clone().next());
    egui::ComboBox::from_id_salt("choice")
        .selected_text(shown.map_or_else(String::new, |shown| name(names, shown)))
        .show_ui(ui, |ui| {
            for entity in all.by_ref() {
                let is_shown = shown == Some(entity);
                if ui.selectable_label(is_shown, name(names, entity)).clicked() {
                    *chosen = Some(entity);
                }
            }
        });
}
