//! Slopes: standing still, walking at the asked speed, sliding down what is too steep.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::{Make, Sim};

use super::support::*;

/// Ramps side by side, each 60 m long, 6 m wide, through `y = 0` at `x = 0`.
fn ramps(sim: &mut Sim, degrees: &[f32]) -> Vec<(f32, Make, Vec3)> {
    let mut middles = Vec::new();
    for (i, &angle) in degrees.iter().enumerate() {
        for (j, make) in Make::ALL.into_iter().enumerate() {
            let middle = Vec3::Z * ((i * 2 + j) as f32 * 8.0);
            sim.ramp(make, middle, angle.to_radians(), 60.0, 6.0);
            middles.push((angle, make, middle));
        }
    }
    middles
}

fn on_ramp(sim: &mut Sim, character: &Character, middle: Vec3, degrees: f32) -> Entity {
    let foot = foot_on_slope(middle, degrees.to_radians(), 0.3);
    runner_with(sim, character.clone(), foot)
}

#[test]
fn a_minute_of_standing_on_a_slope_drifts_less_than_a_millimetre() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let ramps = ramps(&mut sim, &[5.0, 15.0, 25.0, 35.0, 45.0, 49.0]);
        let standers: Vec<_> = ramps
            .iter()
            .map(|&(degrees, make, middle)| {
                let stander = on_ramp(&mut sim, &Character::default(), middle, degrees);
                (degrees, make, stander)
            })
            .collect();
        sim.seconds(1.0);
        let start: Vec<Vec3> = standers.iter().map(|s| sim.position(s.2)).collect();
        sim.seconds(60.0);
        for (&(degrees, make, stander), start) in standers.iter().zip(start) {
            let case = format!("{hz} Hz {degrees}° {make:?}");
            found.at_most(
                format!("{case}: drift"),
                sim.position(stander).distance(start),
                0.001,
            );
            found.holds(format!("{case}: on ground"), sim.state(stander).on_ground());
            let normal = sim.state(stander).ground.normal;
            let (_, wanted) = slope_axes(degrees.to_radians());
            found.at_most(format!("{case}: normal off"), normal.distance(wanted), 1e-3);
        }
    }
}

#[test]
fn a_landing_on_a_slope_does_not_slide_on() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let ramps = ramps(&mut sim, &[10.0, 30.0, 45.0]);
        for (degrees, make, middle) in ramps {
            let faller = runner(
                &mut sim,
                foot_on_slope(middle, degrees.to_radians(), 0.3) + Vec3::Y * 2.0,
            );
            sim.seconds(0.5);
            sim.seconds(1.0);
            let start = sim.position(faller);
            sim.seconds(2.0);
            let case = format!("{hz} Hz {degrees}° {make:?}");
            found.at_most(
                format!("{case}: drift"),
                sim.position(faller).distance(start),
                0.0005,
            );
            found.at_most(
                format!("{case}: speed"),
                sim.state(faller).velocity.length(),
                0.01,
            );
        }
    }
}

fn walk_slopes(slope_speed: SlopeSpeed) {
    let mut found = Findings::new();
    let degrees = [5.0, 15.0, 25.0, 35.0, 45.0];
    let character = Character {
        slope_speed,
        ..default()
    };
    for hz in RATES {
        // Up, down, across, and at an angle.
        for way in [0.0, 180.0, 90.0, 30.0, 150.0] {
            let mut sim = Sim::new(hz);
            let ramps = ramps(&mut sim, &degrees);
            let walkers: Vec<_> = ramps
                .iter()
                .map(|&(degrees, make, middle)| {
                    let side = Vec3::Z * -2.0 * ops::sin(f32::to_radians(way));
                    let walker = on_ramp(&mut sim, &character, middle + side, degrees);
                    (degrees, make, walker)
                })
                .collect();
            sim.seconds(0.4);
            for &(.., walker) in &walkers {
                sim.walk(walker, heading(way));
            }
            sim.seconds(0.1);
            let start: Vec<Vec3> = walkers.iter().map(|w| sim.position(w.2)).collect();
            let time = 0.6;
            let mut airborne = 0;
            for _ in 0..(time * hz).round() as usize {
                sim.ticks(1);
                for &(.., walker) in &walkers {
                    airborne += usize::from(!sim.state(walker).on_ground());
                }
            }
            found.at_most(
                format!("{hz} Hz way {way}°: ticks in the air"),
                airborne as f32,
                0.0,
            );
            for (&(degrees, make, walker), start) in walkers.iter().zip(start) {
                let moved = sim.position(walker) - start;
                let measured = match slope_speed {
                    SlopeSpeed::AlongGround => moved.length(),
                    SlopeSpeed::Horizontal => moved.with_y(0.0).length(),
                };
                let case = format!("{hz} Hz {degrees}° {make:?} way {way}°");
                found.within(
                    format!("{case}: speed"),
                    measured / time as f32,
                    SPEED,
                    0.001,
                );
                // The heading on the map is the one asked for.
                let level = moved.with_y(0.0).normalize_or_zero();
                found.at_most(
                    format!("{case}: off its heading"),
                    level.distance(heading(way)),
                    0.002,
                );
                let (_, normal) = slope_axes(degrees.to_radians());
                found.near(
                    format!("{case}: above the slope"),
                    moved.dot(normal),
                    0.0,
                    0.0005,
                );
            }
        }
    }
}

#[test]
fn walking_a_slope_meets_the_asked_speed_along_it() {
    walk_slopes(SlopeSpeed::AlongGround);
}

#[test]
fn walking_a_slope_meets_the_asked_speed_on_the_map_if_so_configured() {
    walk_slopes(SlopeSpeed::Horizontal);
}

#[test]
fn ground_steeper_than_the_limit_is_slid_down_at_g_sin() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let ramps = ramps(&mut sim, &[55.0, 60.0, 65.0, 70.0, 75.0]);
        let sliders: Vec<_> = ramps
            .iter()
            .map(|&(degrees, make, middle)| {
                let (up_slope, _) = slope_axes(degrees.to_radians());
                let slider = on_ramp(
                    &mut sim,
                    &Character::default(),
                    middle + up_slope * 20.0,
                    degrees,
                );
                (degrees, make, slider)
            })
            .collect();
        sim.seconds(0.2);
        let positions =
            |sim: &Sim| -> Vec<Vec3> { sliders.iter().map(|s| sim.position(s.2)).collect() };
        let first = positions(&sim);
        let mut held = vec![0; sliders.len()];
        let mut second = Vec::new();
        let half = (0.5 * hz) as usize;
        for tick in 1..=2 * half {
            sim.ticks(1);
            for (held, slider) in held.iter_mut().zip(&sliders) {
                *held += usize::from(sim.state(slider.2).ground.state != GroundState::Steep);
            }
            if tick == half {
                second = positions(&sim);
            }
        }
        let third = positions(&sim);
        for (i, &(degrees, make, slider)) in sliders.iter().enumerate() {
            let case = format!("{hz} Hz {degrees}° {make:?}");
            let (up_slope, normal) = slope_axes(degrees.to_radians());
            // The second difference is exact for any scheme under a constant acceleration.
            let bend = (third[i] - second[i]) - (second[i] - first[i]);
            let wanted = G * ops::sin(degrees.to_radians());
            found.within(
                format!("{case}: acceleration"),
                bend.dot(-up_slope) / 0.25,
                wanted,
                0.02,
            );
            found.near(
                format!("{case}: off the slope"),
                (third[i] - first[i]).dot(normal),
                0.0,
                0.002,
            );
            found.near(
                format!("{case}: sideways"),
                third[i].z - first[i].z,
                0.0,
                0.0005,
            );
            found.at_most(format!("{case}: ticks not steep"), held[i] as f32, 0.0);
            let speed = sim.state(slider).velocity.dot(-up_slope);
            let by_path = (third[i] - second[i]).dot(-up_slope) / 0.5 + wanted * 0.25;
            found.within(format!("{case}: velocity told"), speed, by_path, 0.03);
        }
    }
}

#[test]
fn the_limit_decides_between_two_slopes_a_thousandth_apart() {
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            for (limit, holds) in [(0.601, true), (0.599, false)] {
                let mut sim = Sim::new(hz);
                sim.ramp(make, Vec3::ZERO, 0.6, 40.0, 8.0);
                let character = Character {
                    max_slope: limit,
                    step: None,
                    ..default()
                };
                let walker = runner_with(&mut sim, character, foot_on_slope(Vec3::ZERO, 0.6, 0.3));
                sim.seconds(0.5);
                sim.walk(walker, Vec3::X);
                let start = sim.position(walker).x;
                sim.seconds(1.0);
                let moved = sim.position(walker).x - start;
                let case = format!("{hz} Hz {make:?} limit {limit}");
                if holds {
                    found.within(
                        format!("{case}: climbed"),
                        moved,
                        SPEED * ops::cos(0.6),
                        0.002,
                    );
                } else {
                    found.at_most(format!("{case}: climbed"), moved, 0.01);
                }
            }
        }
    }
}

#[test]
fn a_slope_too_steep_cannot_be_run_up_from_level_ground() {
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            for degrees in [55.0, 65.0, 75.0, 85.0] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                sim.ramp(make, Vec3::X * 2.0, f32::to_radians(degrees), 20.0, 20.0);
                let walker = runner(&mut sim, Vec3::ZERO);
                sim.seconds(0.2);
                sim.walk(walker, Vec3::X);
                let mut high = f32::MIN;
                let mut lost = 0;
                for _ in 0..(2.0 * hz) as usize {
                    sim.ticks(1);
                    high = high.max(sim.position(walker).y);
                    lost += usize::from(!sim.state(walker).on_ground());
                }
                let case = format!("{hz} Hz {make:?} {degrees}°");
                found.at_most(format!("{case}: highest"), high, 0.01);
                found.at_most(format!("{case}: ticks off the ground"), lost as f32, 0.0);
            }
        }
    }
}

#[test]
fn walking_along_the_foot_of_a_steep_slope_is_as_fast_as_along_a_wall() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // Rises towards +X; walks along +Z, a little into it.
        sim.ramp(Make::Boxes, Vec3::X * 1.0, 60f32.to_radians(), 20.0, 60.0);
        let walker = runner(&mut sim, Vec3::new(0.0, 0.0, -10.0));
        sim.seconds(0.2);
        sim.walk(walker, heading(80.0));
        sim.seconds(1.0);
        let start = sim.position(walker).z;
        sim.seconds(1.0);
        let wanted = SPEED * ops::cos(10f32.to_radians());
        found.within(
            format!("{hz} Hz"),
            sim.position(walker).z - start,
            wanted,
            0.002,
        );
    }
}

#[test]
fn a_transition_from_slope_to_floor_and_back_is_walked_smoothly() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in [10.0, 20.0, 30.0, 40.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            // Up at x = 3 and down again at the top's mirror.
            let angle = f32::to_radians(degrees);
            let top = 3.0 * ops::tan(angle);
            sim.ramp(
                Make::Boxes,
                Vec3::new(4.5, top * 0.5, 0.0),
                angle,
                3.0 / ops::cos(angle),
                10.0,
            );
            sim.ramp(
                Make::Boxes,
                Vec3::new(7.5, top * 0.5, 0.0),
                -angle,
                3.0 / ops::cos(angle),
                10.0,
            );
            let walker = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.2);
            sim.walk(walker, Vec3::X);
            let (mut airborne, mut slowest, mut fastest): (usize, f32, f32) = (0, f32::MAX, 0.0);
            for _ in 0..(2.4 * hz) as usize {
                let before = sim.position(walker);
                sim.ticks(1);
                let speed = sim.position(walker).distance(before) * hz as f32;
                (slowest, fastest) = (slowest.min(speed), fastest.max(speed));
                airborne += usize::from(!sim.state(walker).on_ground());
            }
            let case = format!("{hz} Hz {degrees}°");
            found.at_most(format!("{case}: ticks in the air"), airborne as f32, 0.0);
            // A kink takes at most the part that its chord cuts off.
            found.at_least(
                format!("{case}: slowest tick"),
                slowest,
                SPEED * ops::cos(angle) * 0.9,
            );
            found.at_least(format!("{case}: past it"), sim.position(walker).x, 9.5);
            found.near(
                format!("{case}: down again"),
                sim.position(walker).y,
                0.0,
                0.001,
            );
        }
    }
}

#[test]
fn walking_over_a_crest_stays_on_the_ground_and_without_snap_it_flies() {
    let mut found = Findings::new();
    for hz in RATES {
        for snap in [0.4, 0.0] {
            let mut sim = Sim::new(hz);
            let angle = 30f32.to_radians();
            sim.block(Vec3::new(-5.0, -0.5, 0.0), Vec3::new(10.0, 1.0, 10.0));
            let (up_slope, _) = slope_axes(-angle);
            sim.ramp(Make::Boxes, up_slope * 6.0, -angle, 12.0, 10.0);
            let character = Character {
                ground_snap: snap,
                ..default()
            };
            let walker = runner_with(&mut sim, character, Vec3::new(-2.0, 0.0, 0.0));
            sim.seconds(0.2);
            sim.walk(walker, Vec3::X);
            let mut airborne = 0;
            for _ in 0..(0.8 * hz) as usize {
                sim.ticks(1);
                airborne += usize::from(!sim.state(walker).on_ground());
            }
            let case = format!("{hz} Hz snap {snap}");
            if snap > 0.0 {
                found.at_most(format!("{case}: ticks in the air"), airborne as f32, 0.0);
            } else {
                found.at_least(
                    format!("{case}: ticks in the air"),
                    airborne as f32,
                    0.1 * hz as f32,
                );
            }
        }
    }
}

#[test]
fn the_steepest_limit_holds_on_everything_and_zero_on_level_ground_alone() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        sim.ramp(
            Make::Boxes,
            Vec3::new(100.0, 20.0, 0.0),
            80f32.to_radians(),
            40.0,
            20.0,
        );
        sim.ramp(
            Make::Boxes,
            Vec3::new(100.0, 20.0, 40.0),
            3f32.to_radians(),
            40.0,
            20.0,
        );
        let all = Character {
            max_slope: core::f32::consts::FRAC_PI_2,
            ..default()
        };
        let none = Character {
            max_slope: 0.0,
            ..default()
        };
        let steep = foot_on_slope(Vec3::new(100.0, 20.0, 0.0), 80f32.to_radians(), 0.3);
        let gentle = foot_on_slope(Vec3::new(100.0, 20.0, 40.0), 3f32.to_radians(), 0.3);
        let holder = runner_with(&mut sim, all, steep);
        let slider = runner_with(&mut sim, none.clone(), gentle);
        let walker = runner_with(&mut sim, none, Vec3::ZERO);
        sim.seconds(0.3);
        let start = [holder, slider, walker].map(|c| sim.position(c));
        sim.walk(walker, Vec3::NEG_X);
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: holds on 80°"),
            sim.position(holder).distance(start[0]),
            0.001,
        );
        found.at_least(
            format!("{hz} Hz: slides on 3°"),
            sim.position(slider).distance(start[1]),
            0.1,
        );
        found.within(
            format!("{hz} Hz: walks on the level"),
            sim.position(walker).distance(start[2]),
            SPEED,
            0.001,
        );
    }
}
