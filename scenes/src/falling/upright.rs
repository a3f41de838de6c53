//! Those who are pushed over and stand up again: a shooting range, uneven ground.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;

use super::{
    FallStation, FallStep, FallTrace, Fallen, during, greatest, larger, last, least,
    stage::{BRICK, Block},
};
use crate::stations::Verdict;

pub(super) fn stations() -> Vec<FallStation> {
    vec![range(), uneven()]
}

/// Facing `+Z`.
fn about() -> Quat {
    Quat::from_rotation_y(core::f32::consts::PI)
}

/// Who gets up by themselves.
pub(super) fn falls(impulse: f32) -> CharacterRagdoll {
    CharacterRagdoll {
        fall_impulse: Some(impulse),
        get_up_after: Some(0.6),
        ..default()
    }
}

/// Whether a figure stands in the end: on its feet, head up.
fn stands(trace: &FallTrace, figure: usize) -> Verdict {
    let Some(f) = last(trace).nth(figure) else {
        return Verdict::never("was there");
    };
    let height = f.head.y - f.foot.y;
    Verdict::new(
        f.phase == BodyPhase::Upright && height > 1.4,
        format!("{:?}, head {height:.2} m above the ground", f.phase),
    )
}

fn range() -> FallStation {
    let wall = Block::on(Vec3::new(0.0, 0.0, -11.0), Vec3::new(12.0, 3.0, 0.5), BRICK);
    FallStation::new(
        "range",
        "push whoever you click at: they flinch, and fall to hard hits",
        -50.0,
        36.0,
    )
    .seen(Vec3::ZERO, Vec3::NEG_Z)
    .ground([wall])
    .cast(|scene| {
        for x in [-1.6, 0.0, 1.6] {
            let at = Transform::from_xyz(x, 0.0, -5.0 - 0.3 * x.abs()).with_rotation(about());
            scene.person(at, falls(100.0));
        }
    })
    .steps([
        FallStep::wait("three stand", 0.5),
        FallStep::once("12 Ns at a forearm", 2.5, |scene| {
            scene.hit(0, "forearm_l", Vec3::new(0.0, 0.0, -12.0));
        }),
        FallStep::once("150 Ns at a chest, which throws it down", 0.8, |scene| {
            scene.fall(1);
            scene.hit(1, "chest", Vec3::new(0.0, 20.0, -150.0));
        }),
        FallStep::wait("it lies, and gets up by itself", 7.5),
    ])
    .ask("who is hit at the arm flinches there", |trace| {
        let most = during(trace, 1, 0).map(|(_, f)| f.simulated[0]).max();
        let most = most.unwrap_or(0);
        Verdict::new((2..19).contains(&most), format!("{most} bones let go"))
    })
    .ask("and is as before after 2 s, in its place", |trace| {
        let Some((_, before)) = during(trace, 0, 0).last() else {
            return Verdict::never("stood");
        };
        let Some((_, after)) = during(trace, 1, 0).last() else {
            return Verdict::never("was hit");
        };
        let moved = after.foot.distance(before.foot);
        Verdict::new(
            after.simulated[0] == 0 && moved < 0.005,
            format!(
                "{} bones loose, {:.1} mm off",
                after.simulated[0],
                1e3 * moved
            ),
        )
    })
    .ask("150 N·s is what the chest gets, within 10 %", |trace| {
        let first = during(trace, 2, 1).take(3);
        let got = greatest(first.map(|(_, f)| -f.momentum.z));
        Verdict::close(got.into(), 150.0, 0.1, format!("{got:.0} N·s"))
    })
    .ask("the others are not moved by it", |trace| {
        let still = |figure| {
            let places = during(trace, 2, figure).chain(during(trace, 3, figure));
            let places: Vec<Vec3> = places.map(|(_, f)| f.foot).collect();
            greatest(places.iter().map(|p| p.distance(places[0])))
        };
        let moved = larger(still(0), still(2));
        Verdict::at_most(moved.into(), 0.005, format!("{:.1} mm", 1e3 * moved))
    })
    .ask("it lies", |trace| {
        let lows = during(trace, 3, 1).map(|(_, f)| f.head.y);
        let low = least(lows);
        Verdict::at_most(low.into(), 0.5, format!("head at {low:.2} m"))
    })
    .ask("and stands again", |trace| stands(trace, 1))
    .ask_whole(0.05, 0.06)
}

fn uneven() -> FallStation {
    // Slabs that lean every way, up to 14 degrees.
    let slab = |i: i16, j: i16| {
        let n = (i * 7 + j * 13) as f32;
        let lean = Quat::from_euler(
            EulerRot::XYZ,
            0.25 * ops::sin(1.7 * n),
            0.4 * n,
            0.25 * ops::cos(2.3 * n),
        );
        let height = 0.2 * ops::sin(0.9 * n + 1.0);
        let at = Vec3::new(1.3 * f32::from(i), height, 1.3 * f32::from(j));
        let gray = 0.5 + 0.06 * ops::sin(3.1 * n);
        Block {
            at: Transform::from_translation(at).with_rotation(lean),
            size: Vec3::new(2.0, 0.5, 2.0),
            color: [gray, gray * 0.98, gray * 0.9],
        }
    };
    let slabs = (-4..=4).flat_map(move |i| (-4..=4).map(move |j| slab(i, j)));
    FallStation::new(
        "uneven",
        "falls on a field of leaning slabs, and gets up",
        -116.0,
        -5.0,
    )
    .seen(Vec3::new(0.0, 0.0, 8.0), Vec3::ZERO)
    .ground(slabs)
    .cast(|scene| {
        for (n, x) in [-2.6f32, 0.0, 2.6].into_iter().enumerate() {
            let turn = Quat::from_rotation_y(1.9 * n as f32);
            let at = Transform::from_xyz(x, 0.75, 0.4 * x).with_rotation(turn);
            scene.person(at, falls(100.0));
        }
    })
    .steps([
        FallStep::wait("three stand on it", 0.8),
        FallStep::once("each is pushed over another way", 3.0, |scene| {
            for (n, push) in [Vec3::NEG_Z, Vec3::X, Vec3::new(-0.7, 0.0, 0.7)]
                .into_iter()
                .enumerate()
            {
                scene.fall(n);
                scene.hit(n, "chest", 130.0 * push);
            }
        }),
        FallStep::wait("they get up", 7.0),
    ])
    .ask("all three were down", |trace| {
        let down = |n| during(trace, 1, n).any(|(_, f)| f.head.y - f.foot.y < 0.7);
        let count = (0..3).filter(|n| down(*n)).count();
        Verdict::new(count == 3, format!("{count} of 3"))
    })
    .ask("all three stand again", |trace| {
        let up = last(trace).filter(|f| f.phase == BodyPhase::Upright && f.head.y - f.foot.y > 1.4);
        let count = up.count();
        Verdict::new(count == 3, format!("{count} of 3"))
    })
    .ask("with their feet on the slabs", |trace| {
        let slabs: Vec<Block> = uneven_blocks();
        let off = |f: &Fallen| {
            let depth = |b: &Block| b.depth(f.foot, 0.0);
            greatest(slabs.iter().map(depth)).abs()
        };
        let worst = greatest(last(trace).map(off));
        Verdict::at_most(worst.into(), 0.25, format!("{:.0} mm off", 1e3 * worst))
    })
    .ask_whole(0.06, 0.06)
}

/// The slabs in the station's axes.
fn uneven_blocks() -> Vec<Block> {
    uneven().ground
}
