//! What the dog looks like: coat, pale muzzle and paws, nose, eyes and collar.

use bevy::math::{DQuat, DVec3};

use super::bones::at;
use crate::figures::{
    field::{Blob, Field},
    surface::{Shell, shell},
};

const COAT: [f64; 3] = [0.36, 0.17, 0.06];
const DARK: [f64; 3] = [0.12, 0.055, 0.025];
const PALE: [f64; 3] = [0.74, 0.6, 0.42];
const INK: [f64; 3] = [0.015, 0.013, 0.013];
const COLLAR: [f64; 3] = [0.45, 0.045, 0.04];

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn trunk() -> Field {
    let mut f = Field::default();
    f.add(
        Blob::cone([v(0.0, 0.465, 0.13), v(0.0, 0.485, 0.02)], [0.124, 0.112])
            .squash(DVec3::X, 0.82),
    )
    .add(
        Blob::cone([v(0.0, 0.49, 0.02), v(0.0, 0.515, -0.17)], [0.106, 0.08])
            .squash(DVec3::X, 0.85)
            .blend(0.02),
    )
    .add(
        Blob::cone([v(0.0, 0.515, -0.17), v(0.0, 0.51, -0.31)], [0.08, 0.088])
            .squash(DVec3::X, 0.95)
            .blend(0.02),
    )
    .add(
        Blob::cone(
            [v(0.0, 0.53, 0.2), at::HEAD - v(0.0, 0.02, 0.01)],
            [0.086, 0.06],
        )
        .squash(DVec3::X, 0.85)
        .blend(0.05),
    )
    .add(Blob::ball(v(0.0, 0.45, 0.215), v(0.06, 0.075, 0.045)).blend(0.05));
    // Tail.
    let t = at::TAIL;
    f.add(Blob::cone([t[0] + v(0.0, 0.0, 0.03), t[1]], [0.034, 0.027]).blend(0.03))
        .add(Blob::cone([t[1], t[2]], [0.027, 0.025]).blend(0.006))
        .add(Blob::cone([t[2], t[3]], [0.025, 0.018]).blend(0.006));
    // Front legs.
    let [blade, shoulder, elbow, wrist, paw, tip] = at::FRONT;
    f.pair(
        Blob::cone([blade + v(0.01, -0.03, 0.0), shoulder], [0.045, 0.05])
            .squash(DVec3::X, 0.75)
            .blend(0.05),
    )
    .pair(
        Blob::cone([shoulder, elbow], [0.052, 0.042])
            .squash(DVec3::X, 0.85)
            .blend(0.03),
    )
    .pair(Blob::cone([elbow, wrist], [0.04, 0.027]).blend(0.012))
    .pair(Blob::cone([wrist, paw], [0.027, 0.026]).blend(0.006))
    .pair(
        Blob::ball(
            paw.lerp(tip, 0.5) + v(0.0, 0.004, 0.0),
            v(0.034, 0.026, 0.044),
        )
        .cut(v(0.0, 0.004, 0.0), -DVec3::Y)
        .blend(0.02),
    );
    // Back legs.
    let [hip, knee, heel, hind, toe] = at::BACK;
    f.pair(
        Blob::cone([hip + v(-0.006, -0.02, 0.005), knee], [0.086, 0.052])
            .squash(DVec3::X, 0.68)
            .blend(0.05),
    )
    .pair(
        Blob::cone([knee, heel], [0.05, 0.026])
            .squash(DVec3::X, 0.9)
            .blend(0.02),
    )
    .pair(Blob::cone([heel, hind], [0.027, 0.024]).blend(0.008))
    .pair(
        Blob::ball(
            hind.lerp(toe, 0.5) + v(0.0, 0.004, 0.0),
            v(0.032, 0.026, 0.044),
        )
        .cut(v(0.0, 0.004, 0.0), -DVec3::Y)
        .blend(0.02),
    );
    f
}

fn head() -> Field {
    let mut f = Field::default();
    f.add(Blob::ball(v(0.0, 0.722, 0.378), v(0.068, 0.066, 0.078)))
        .add(Blob::cone([v(0.0, 0.7, 0.42), v(0.0, 0.682, 0.5)], [0.046, 0.034]).blend(0.04))
        .pair(Blob::ball(v(0.03, 0.745, 0.425), v(0.022, 0.016, 0.022)).blend(0.03));
    f
}

/// Small things with a box about them.
fn dot(blob: Blob, center: DVec3, reach: f64, cell: f64, color: [f64; 3]) -> Shell {
    let mut f = Field::default();
    f.add(blob);
    let half = DVec3::splat(reach);
    shell(&f, [center - half, center + half], cell, color)
}

pub fn shells() -> Vec<Shell> {
    let both = |one: Shell| [one.mirrored(), one];
    let (low, high) = (v(-0.15, -0.01, -0.71), v(0.15, 0.77, 0.42));
    let mut all = vec![shell(&trunk(), [low, high], 0.02, COAT)];
    let (low, high) = (v(-0.085, 0.62, 0.27), v(0.085, 0.81, 0.56));
    all.push(shell(&head(), [low, high], 0.0135, COAT));
    let muzzle = v(0.0, 0.676, 0.5);
    let pale = Blob::cone([v(0.0, 0.682, 0.45), v(0.0, 0.673, 0.508)], [0.0385, 0.033]);
    all.push(dot(pale, muzzle, 0.1, 0.0125, PALE));
    let nose = v(0.0, 0.694, 0.536);
    all.push(dot(
        Blob::ball(nose, v(0.017, 0.013, 0.013)),
        nose,
        0.02,
        0.0075,
        INK,
    ));
    let eye = v(0.04, 0.732, 0.444);
    all.extend(both(dot(
        Blob::ball(eye, v(0.0085, 0.01, 0.009)),
        eye,
        0.014,
        0.0055,
        INK,
    )));
    let [root, tip] = at::EAR;
    let middle = root.lerp(tip, 0.55);
    let turn = DQuat::from_rotation_z(0.38);
    let ear = Blob::turned_ball(middle, v(0.013, 0.056, 0.034), turn);
    all.extend(both(dot(ear, middle, 0.07, 0.0125, DARK)));
    let along = (at::HEAD - at::NECK).normalize();
    let ring = at::NECK.lerp(at::HEAD, 0.62) - v(0.0, 0.006, 0.004);
    let round = DQuat::from_rotation_arc(DVec3::Y, along);
    let collar = Blob::turned_ball(ring, v(0.069, 0.024, 0.0785), round);
    all.push(dot(collar, ring, 0.09, 0.0125, COLLAR));
    all
}
