//! What the human looks like: skin, hair, shirt, trousers and shoes, each a closed shell.

use bevy::math::{DQuat, DVec3};

use super::bones::{arm, at, hand, palm};
use crate::figures::{
    field::{Blob, Field},
    surface::{Shell, shell},
};

const SKIN: [f64; 3] = [0.73, 0.42, 0.28];
const HAIR: [f64; 3] = [0.075, 0.042, 0.025];
const INK: [f64; 3] = [0.02, 0.018, 0.02];
const LIP: [f64; 3] = [0.5, 0.2, 0.16];
const SHIRT: [f64; 3] = [0.07, 0.34, 0.31];
const TROUSERS: [f64; 3] = [0.055, 0.07, 0.13];
const SHOE: [f64; 3] = [0.62, 0.19, 0.11];
const SOLE: [f64; 3] = [0.86, 0.84, 0.79];

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A box about the middle plane of the body.
fn middle(half: f64, low: f64, high: f64, back: f64, front: f64) -> [DVec3; 2] {
    [v(-half, low, back), v(half, high, front)]
}

fn head() -> Field {
    let mut f = Field::default();
    f.add(Blob::ball(v(0.0, 1.702, -0.012), v(0.074, 0.094, 0.094)))
        .add(Blob::ball(v(0.0, 1.655, 0.026), v(0.058, 0.082, 0.064)).blend(0.04))
        .add(Blob::ball(v(0.0, 1.598, 0.056), v(0.034, 0.026, 0.032)).blend(0.05))
        .pair(Blob::ball(v(0.044, 1.622, 0.02), v(0.018, 0.03, 0.03)).blend(0.04))
        .add(Blob::cone([v(0.0, 1.42, -0.035), v(0.0, 1.62, -0.012)], [0.06, 0.051]).blend(0.03))
        .add(Blob::cone([v(0.0, 1.684, 0.085), v(0.0, 1.65, 0.106)], [0.007, 0.013]).blend(0.014))
        .pair(Blob::ball(v(0.03, 1.703, 0.068), v(0.024, 0.008, 0.013)).blend(0.03))
        .pair(
            Blob::turned_ball(
                v(0.077, 1.664, -0.006),
                v(0.01, 0.032, 0.02),
                DQuat::from_rotation_y(-0.4),
            )
            .blend(0.012),
        );
    f
}

fn hair() -> Field {
    let mut f = Field::default();
    let (hairline, face) = (v(0.0, 1.748, 0.082), v(0.0, -0.155, 0.145));
    f.add(Blob::ball(v(0.0, 1.712, -0.02), v(0.083, 0.096, 0.098)).cut(hairline, face))
        .add(Blob::ball(v(0.0, 1.775, 0.03), v(0.058, 0.03, 0.056)).blend(0.03))
        .add(Blob::ball(v(0.0, 1.64, -0.07), v(0.052, 0.045, 0.036)).blend(0.04));
    f
}

fn left_arm() -> Field {
    let (shoulder, elbow, wrist, _) = arm();
    let mut f = Field::default();
    f.add(Blob::cone(
        [shoulder.lerp(elbow, 0.35), elbow],
        [0.044, 0.037],
    ))
    .add(Blob::cone([elbow, elbow.lerp(wrist, 0.3)], [0.037, 0.041]).blend(0.004))
    .add(Blob::cone([elbow.lerp(wrist, 0.3), wrist], [0.041, 0.027]).blend(0.004));
    f
}

fn left_hand() -> Field {
    let (_, elbow, wrist, _) = arm();
    let thin = palm();
    let mut f = Field::default();
    f.add(Blob::cone(
        [elbow.lerp(wrist, 0.93), wrist],
        [0.0265, 0.0245],
    ))
    .add(
        Blob::cone([hand(0.03, 0.0, 0.0), hand(0.085, 0.0, 0.0)], [0.032, 0.04])
            .squash(thin, 0.45)
            .blend(0.02),
    )
    .add(
        Blob::cone(
            [hand(0.085, -0.004, 0.002), hand(0.155, -0.006, 0.012)],
            [0.037, 0.024],
        )
        .squash(thin, 0.42)
        .blend(0.012),
    )
    .add(
        Blob::cone(
            [hand(0.025, 0.022, 0.002), hand(0.056, 0.05, 0.008)],
            [0.0175, 0.0145],
        )
        .blend(0.02),
    )
    .add(
        Blob::cone(
            [hand(0.056, 0.05, 0.008), hand(0.082, 0.066, 0.012)],
            [0.0145, 0.0115],
        )
        .blend(0.012),
    );
    f
}

fn shirt() -> Field {
    let (shoulder, elbow, ..) = arm();
    let along = (elbow - shoulder).normalize();
    let mut f = Field::default();
    f.add(Blob::ball(v(0.0, 1.31, -0.014), v(0.162, 0.19, 0.112)))
        .add(Blob::ball(v(0.0, 1.12, -0.002), v(0.144, 0.2, 0.1)).blend(0.05))
        .add(
            Blob::ball(v(0.0, 0.965, -0.006), v(0.172, 0.2, 0.124))
                .cut(v(0.0, 0.905, 0.0), -DVec3::Y)
                .blend(0.03),
        )
        .pair(Blob::ball(v(0.066, 1.36, 0.05), v(0.078, 0.06, 0.04)).blend(0.06))
        .pair(
            Blob::cone(
                [v(0.02, 1.458, -0.035), v(0.15, 1.412, -0.024)],
                [0.06, 0.058],
            )
            .blend(0.04),
        )
        .pair(
            Blob::cone(
                [shoulder - DVec3::Y * 0.008, shoulder + along * 0.2],
                [0.064, 0.062],
            )
            .cut(shoulder + along * 0.165, along)
            .blend(0.025),
        );
    f
}

fn trousers() -> Field {
    let hem = v(0.0, 0.085, 0.0);
    let mut f = Field::default();
    f.add(Blob::ball(v(0.0, 0.95, -0.004), v(0.158, 0.1, 0.11)))
        .pair(Blob::ball(v(0.066, 0.9, -0.05), v(0.075, 0.085, 0.075)).blend(0.05))
        .pair(Blob::cone([at::HIP - DVec3::Y * 0.04, at::KNEE], [0.082, 0.058]).blend(0.025))
        .pair(Blob::cone([at::KNEE, v(0.098, 0.36, -0.014)], [0.058, 0.06]).blend(0.004))
        .pair(
            Blob::cone(
                [v(0.098, 0.36, -0.014), v(0.098, 0.04, -0.02)],
                [0.06, 0.05],
            )
            .cut(hem, -DVec3::Y)
            .blend(0.004),
        );
    f
}

fn left_shoe() -> Field {
    let floor = v(0.0, 0.014, 0.0);
    let mut f = Field::default();
    f.add(
        Blob::cone(
            [v(0.098, 0.045, -0.04), v(0.105, 0.034, 0.1)],
            [0.042, 0.042],
        )
        .cut(floor, -DVec3::Y),
    )
    .add(
        Blob::cone(
            [v(0.105, 0.034, 0.1), v(0.106, 0.028, 0.15)],
            [0.042, 0.036],
        )
        .cut(floor, -DVec3::Y)
        .blend(0.01),
    )
    .add(
        Blob::cone(
            [v(0.098, 0.06, -0.028), v(0.098, 0.16, -0.024)],
            [0.046, 0.044],
        )
        .cut(v(0.0, 0.118, 0.0), v(0.0, 1.0, -0.2))
        .blend(0.04),
    );
    f
}

fn left_sole() -> Field {
    let mut f = Field::default();
    let (heel, ball, toe) = (
        v(0.098, 0.013, -0.042),
        v(0.107, 0.013, 0.1),
        v(0.107, 0.013, 0.148),
    );
    f.add(Blob::cone([heel, ball], [0.045, 0.0465]).squash(DVec3::Y, 0.28))
        .add(
            Blob::cone([ball, toe], [0.0465, 0.04])
                .squash(DVec3::Y, 0.29)
                .blend(0.01),
        );
    f
}

/// A single small blob with the box about it.
fn dot(blob: Blob, center: DVec3, reach: f64, color: [f64; 3]) -> Shell {
    let mut f = Field::default();
    f.add(blob);
    let half = DVec3::splat(reach);
    shell(&f, [center - half, center + half], 0.0062, color)
}

fn face() -> Vec<Shell> {
    let eye = v(0.0305, 1.676, 0.0875);
    let eye = dot(Blob::ball(eye, v(0.0085, 0.0125, 0.006)), eye, 0.016, INK);
    let brow = v(0.031, 1.706, 0.0885);
    let shape = Blob::turned_ball(brow, v(0.019, 0.005, 0.008), DQuat::from_rotation_y(0.35));
    let brow = dot(shape, brow, 0.024, HAIR);
    let mouth = v(0.0, 1.617, 0.0885);
    let mouth = dot(Blob::ball(mouth, v(0.019, 0.005, 0.009)), mouth, 0.024, LIP);
    vec![eye.mirrored(), eye, brow.mirrored(), brow, mouth]
}

pub fn shells() -> Vec<Shell> {
    let both = |one: Shell| [one.mirrored(), one];
    let (_, elbow, wrist, _) = arm();
    let arm = [
        v(0.19, wrist.y - 0.03, -0.1),
        v(wrist.x + 0.03, elbow.y + 0.18, 0.06),
    ];
    let hand = [wrist - v(0.06, 0.18, 0.06), wrist + v(0.17, 0.06, 0.13)];
    let mut all = vec![
        shell(&head(), middle(0.112, 1.34, 1.83, -0.14, 0.15), 0.019, SKIN),
        shell(&hair(), middle(0.112, 1.56, 1.84, -0.15, 0.13), 0.02, HAIR),
        shell(
            &shirt(),
            middle(0.416, 0.85, 1.55, -0.18, 0.18),
            0.035,
            SHIRT,
        ),
        shell(
            &trousers(),
            middle(0.208, 0.04, 1.09, -0.17, 0.15),
            0.035,
            TROUSERS,
        ),
    ];
    all.extend(both(shell(&left_arm(), arm, 0.022, SKIN)));
    all.extend(both(shell(&left_hand(), hand, 0.0115, SKIN)));
    let shoe = [v(0.02, -0.02, -0.12), v(0.18, 0.16, 0.22)];
    all.extend(both(shell(&left_shoe(), shoe, 0.02, SHOE)));
    all.extend(both(shell(&left_sole(), shoe, 0.016, SOLE)));
    all.extend(face());
    all
}
