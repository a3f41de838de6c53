//! One text and one colour for each thing that can be found out about a character, the same in
//! gizmos, panel and overlays.

use bevy::{color::palettes::tailwind, prelude::*};

use crate::character::{GroundState, StanceRefusal, StepResult};

/// How a finding is shown.
///
/// | ground | colour | | step | colour |
/// |---|---|---|---|---|
/// | on ground | green | | climbed | green |
/// | steep | orange | | no landing | grey |
/// | unsupported | violet | | too high | red |
/// | in air | blue | | too steep | orange |
/// | | | | too narrow | yellow |
/// | | | | no room | violet |
/// | | | | dynamic body | cyan |
/// | | | | no progress | white |
pub trait Explain {
    /// What it says, short, without a capital.
    fn text(&self) -> String;
    /// What it looks like.
    fn color(&self) -> Color;
}

impl Explain for GroundState {
    fn text(&self) -> String {
        match self {
            Self::OnGround => "on ground",
            Self::Steep => "steep",
            Self::Unsupported => "unsupported",
            Self::InAir => "in air",
        }
        .into()
    }

    fn color(&self) -> Color {
        match self {
            Self::OnGround => tailwind::GREEN_400,
            Self::Steep => tailwind::ORANGE_400,
            Self::Unsupported => tailwind::VIOLET_400,
            Self::InAir => tailwind::SKY_400,
        }
        .into()
    }
}

impl Explain for StepResult {
    fn text(&self) -> String {
        match self {
            Self::Climbed(height) => return format!("climbed {height:.3} m"),
            Self::NoLanding => "no landing behind the riser",
            Self::TooHigh => "too high",
            Self::TooSteep => "landing too steep",
            Self::TooNarrow => "landing too narrow",
            Self::NoRoom => "no room for the body",
            Self::Dynamic => "landing is a dynamic body",
            Self::NoProgress => "no progress",
        }
        .into()
    }

    fn color(&self) -> Color {
        match self {
            Self::Climbed(_) => tailwind::GREEN_400,
            Self::NoLanding => tailwind::GRAY_400,
            Self::TooHigh => tailwind::RED_500,
            Self::TooSteep => tailwind::ORANGE_400,
            Self::TooNarrow => tailwind::YELLOW_300,
            Self::NoRoom => tailwind::VIOLET_400,
            Self::Dynamic => tailwind::CYAN_400,
            Self::NoProgress => tailwind::GRAY_50,
        }
        .into()
    }
}

impl Explain for StanceRefusal {
    fn text(&self) -> String {
        match self {
            Self::Blocked { by, room } => format!("room for {room:.2} m only, below {by}"),
            Self::BadHeight(height) => format!("{height} is no height"),
        }
    }

    fn color(&self) -> Color {
        tailwind::RED_500.into()
    }
}
