use bevy::math::Quat;

use super::*;

fn down(center: Vec3) -> WheelCast {
    WheelCast::new(center, Vec3::X, 0.3, 0.1, Vec3::NEG_Y).unwrap()
}

fn triangle(a: Vec3, b: Vec3, c: Vec3) -> Triangle {
    Triangle::new(a, b, c).unwrap()
}

#[test]
fn on_a_floor_the_wheel_comes_down_to_its_radius() {
    let floor = triangle(
        Vec3::new(-5.0, 0.0, -5.0),
        Vec3::new(0.0, 0.0, 5.0),
        Vec3::new(5.0, 0.0, -5.0),
    );
    let hit = down(Vec3::Y).cast(&floor, 2.0).unwrap();
    assert!((hit.distance - 0.7).abs() < 1.0e-6, "{hit:?}");
    assert!(hit.normal.distance(Vec3::Y) < 1.0e-6 && hit.point.length() < 1.0e-6);
    assert!(down(Vec3::Y).cast(&floor, 0.6).is_none());
}

#[test]
fn on_a_slope_across_the_rim_stands_on_the_face() {
    let slope = triangle(
        Vec3::new(-5.0, -1.0, -5.0),
        Vec3::new(-5.0, -1.0, 5.0),
        Vec3::new(5.0, 1.0, 0.0),
    );
    let hit = down(Vec3::Y).cast(&slope, 2.0).unwrap();
    // The higher rim is 0.1 m aside, where the slope is 0.02 m up.
    assert!((hit.distance - 0.68).abs() < 1.0e-5, "{hit:?}");
    let up = Vec3::new(-0.2, 1.0, 0.0).normalize();
    assert!(hit.normal.distance(up) < 1.0e-5, "{hit:?}");
}

#[test]
fn a_kerb_is_met_by_the_tread_along_its_radius() {
    // The edge of a step 0.18 m before the hub: 0.24 m of the radius are above it.
    let kerb = triangle(
        Vec3::new(-5.0, 0.1, -0.18),
        Vec3::new(5.0, 0.1, -0.18),
        Vec3::new(0.0, 0.1, -9.0),
    );
    let hit = down(Vec3::Y).cast(&kerb, 2.0).unwrap();
    assert!((hit.distance - (0.9 - 0.24)).abs() < 1.0e-5, "{hit:?}");
    let radial = Vec3::new(0.0, 0.24, 0.18) / 0.3;
    assert!(hit.normal.distance(radial) < 1.0e-5, "{hit:?}");
}

#[test]
fn a_face_in_the_way_of_the_start_counts_only_if_the_wheel_moves_into_it() {
    let at = |y: f32| {
        triangle(
            Vec3::new(-5.0, y, -5.0),
            Vec3::new(0.0, y, 5.0),
            Vec3::new(5.0, y, -5.0),
        )
    };
    assert!(down(Vec3::ZERO).cast(&at(0.1), 1.0).is_none());
    let hit = down(Vec3::ZERO).cast(&at(-0.1), 1.0).unwrap();
    assert!(hit.distance == 0.0 && hit.normal.distance(Vec3::Y) < 1.0e-6);
    assert!(down(Vec3::ZERO).cast(&at(0.5), 1.0).is_none());
}

#[test]
fn no_sampled_point_of_the_triangle_is_inside_the_wheel_before_it_touches() {
    let mut seed = 11u32;
    let mut next = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let mut hits = 0;
    for _ in 0..3000 {
        let mut v = || Vec3::new(next(), next(), next());
        let (a, b, c) = (v(), v(), v());
        let Some(t) = Triangle::new(a, b, c) else {
            continue;
        };
        let wheel = down(Vec3::Y * 2.0);
        let mut least = f32::MAX;
        for i in 0..=60 {
            for j in 0..=(60 - i) {
                let q = a + (b - a) * (i as f32 / 60.0) + (c - a) * (j as f32 / 60.0);
                if q.x.abs() <= 0.1 && q.z.abs() <= 0.3 {
                    least = least.min(2.0 - q.y - (0.09 - q.z * q.z).sqrt());
                }
            }
        }
        match wheel.cast(&t, 4.0) {
            Some(hit) => {
                hits += 1;
                assert!(hit.distance <= least + 1.0e-4, "{t:?} {hit:?} {least}");
                // A steep face may come between two samples.
                let steep = t.normal.y.abs() < 0.3;
                assert!(steep || least == f32::MAX || hit.distance > least - 0.3);
            }
            None => assert!(least == f32::MAX, "{t:?} {least}"),
        }
    }
    assert!(hits > 300, "{hits}");
}

#[test]
fn a_box_is_touched_as_the_triangles_of_its_surface_are() {
    let mut seed = 5u32;
    let mut next = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let mut hits = 0;
    for _ in 0..2000 {
        let mut v = || Vec3::new(next(), next(), next());
        let cuboid = Cuboid {
            center: v() * 0.6,
            rotation: Quat::from_scaled_axis(v() * 2.0),
            half: v().abs() * 0.5 + 0.05,
        };
        let wheel = down(Vec3::Y * 2.5);
        let corner = |x: f32, y: f32, z: f32| {
            cuboid.center + cuboid.rotation * (cuboid.half * Vec3::new(x, y, z))
        };
        let mut least = f32::MAX;
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let at = |u: f32, v: f32| {
                    let mut p = [side; 3];
                    (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v);
                    corner(p[0], p[1], p[2])
                };
                let (a, b, c, d) = (at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0));
                for t in [triangle(a, b, c), triangle(a, c, d)] {
                    if let Some(touch) = wheel.cast(&t, 5.0) {
                        least = least.min(touch.distance);
                    }
                }
            }
        }
        match wheel.cast_box(&cuboid, 5.0) {
            Some(touch) => {
                hits += 1;
                assert!((touch.distance - least).abs() < 1.0e-4, "{touch:?} {least}");
                assert!(touch.normal.y > 0.0, "{touch:?}");
            }
            None => assert!(least == f32::MAX, "{cuboid:?} {least}"),
        }
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn a_huge_floor_is_as_exact_as_a_small_one() {
    let turned = Quat::from_rotation_y(0.7);
    for half in [1.0, 5000.0] {
        let floor = Cuboid {
            center: Vec3::NEG_Y * 0.5,
            rotation: turned,
            half: Vec3::new(half, 0.5, half),
        };
        let hit = down(Vec3::Y).cast_box(&floor, 2.0).unwrap();
        assert!((hit.distance - 0.7).abs() < 1.0e-6, "{half}: {hit:?}");
    }
}

#[test]
fn a_box_without_thickness_holds_a_wheel_on_its_edge() {
    // Each axis without thickness in turn: lying, along the way and across it.
    for (half, top) in [
        (Vec3::new(0.5, 0.0, 0.5), 0.0),
        (Vec3::new(0.0, 0.5, 0.5), 0.5),
        (Vec3::new(0.5, 0.5, 0.0), 0.5),
    ] {
        let plate = Cuboid {
            center: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            half,
        };
        let hit = down(Vec3::Y * 2.0).cast_box(&plate, 3.0);
        let hit = hit.unwrap_or_else(|| panic!("falls through {half}"));
        let wanted = 2.0 - 0.3 - top;
        assert!((hit.distance - wanted).abs() < 1.0e-5, "{half}: {hit:?}");
        assert!(hit.normal.distance(Vec3::Y) < 1.0e-5, "{half}: {hit:?}");
    }
}
