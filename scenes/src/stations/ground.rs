//! Level and wavy ground: the plaza and the terrain.

use bevy::prelude::*;
use bevy_embody::character::CharacterMotor;

use super::{
    Station, Step, Verdict,
    measure::{ahead, at_speed, never_airborne, within_time},
    trace::{duration, path, range},
};
use crate::course::layout::{PLAZA, PLAZA_WALK, terrain};

pub(super) fn stations() -> Vec<Station> {
    vec![plaza(), wavy()]
}

fn plaza() -> Station {
    let motor = CharacterMotor::default();
    let (speed, jump) = (motor.walk_speed, motor.jump_height);
    Station::new("plaza", "walk down the avenue and jump", PLAZA)
        .script([
            Step::Wait(0.3),
            Step::walk(Vec3::NEG_Z * PLAZA_WALK, 1.2 * PLAZA_WALK / speed),
            Step::Wait(0.4),
            Step::Jump(1.4),
        ])
        .ask(format!("walk at {speed} m/s within 0.1 %"), move |trace| {
            let (from, to) = (2.0, PLAZA_WALK - 2.0);
            at_speed(trace.step(1), ahead, [from, to], to - from, speed, 1e-3)
        })
        .ask("stay at one height within 0.5 mm", |trace| {
            let (low, high) = range(trace.step(1), |s| s.foot.y);
            Verdict::at_most(
                f64::from(high - low),
                0.5e-3,
                format!("{:.3} mm", (high - low) * 1e3),
            )
        })
        .ask("never leave the ground on the way", |trace| {
            never_airborne(trace.step(1))
        })
        .ask(
            format!("jump {jump} m high within 1 cm, and land"),
            move |trace| {
                let ticks = trace.step(3);
                let (low, high) = range(ticks, |s| s.foot.y);
                let landed = trace.last().is_some_and(super::Sample::on_ground);
                Verdict::new(
                    (high - low - jump).abs() <= 0.01 && landed,
                    format!(
                        "{:.4} m, {}",
                        high - low,
                        if landed { "landed" } else { "did not land" }
                    ),
                )
            },
        )
}

fn wavy() -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let (near, far) = (
        -terrain::CENTER.z - terrain::HALF,
        -terrain::CENTER.z + terrain::HALF,
    );
    let goal = far + 1.0;
    let on_it = move |sample: &super::Sample| (near + 0.5..far - 0.5).contains(&ahead(sample));
    Station::new("terrain", "walk across a wavy mesh", terrain::PLACE)
        .script([
            Step::Wait(0.3),
            Step::walk(Vec3::NEG_Z * goal, 1.5 * goal / speed),
        ])
        .ask(
            format!("{speed} m/s along the ground within 2 %"),
            move |trace| {
                let crossed: Vec<_> = trace.step(1).iter().filter(|s| on_it(s)).cloned().collect();
                let time = duration(&crossed);
                if time == 0.0 {
                    return Verdict::never("was on the mesh");
                }
                let got = f64::from(path(&crossed)) / time;
                Verdict::close(got, f64::from(speed), 0.02, format!("{got:.3} m/s"))
            },
        )
        .ask("never leave the ground", |trace| {
            never_airborne(trace.step(1))
        })
        .ask(
            "foot 1 mm below to 10 cm above the triangles",
            move |trace| {
                let crossed: Vec<_> = trace.step(1).iter().filter(|s| on_it(s)).cloned().collect();
                let (low, high) = range(&crossed, |s| {
                    let local = s.foot - terrain::CENTER;
                    // The mesh is in the axes of the place, as the trace is.
                    s.foot.y - terrain::mesh_height(local.x, local.z)
                });
                Verdict::new(
                    low >= -0.001 && high <= 0.1,
                    format!("{:.1} to {:.1} mm", low * 1e3, high * 1e3),
                )
            },
        )
        .ask(
            "no slower than 1.3 times the time on the map",
            move |trace| {
                within_time(
                    trace.step(1),
                    ahead,
                    [near, far],
                    1.3 * (far - near) / speed,
                )
            },
        )
}
