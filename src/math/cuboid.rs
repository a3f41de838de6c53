//! Distance of a segment and a box.
//!
//! The squared distance of a point that runs along the segment to the box is convex and piecewise
//! quadratic; its derivative is piecewise linear with kinks where a coordinate enters or leaves the
//! box's slab. The root of the derivative is found exactly between two kinks. A segment that meets
//! the box is pushed out whole through the face that needs least.

use bevy::math::{Quat, Vec3};

use super::{Closest, RAY_SLACK};

/// A box with a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cuboid {
    pub center: Vec3,
    pub rotation: Quat,
    pub half: Vec3,
}

impl Cuboid {
    /// Closest pair with the segment `p0 p1`; `up` chooses among faces that share the point.
    #[inline]
    pub fn closest_to_segment(&self, p0: Vec3, p1: Vec3, up: Vec3) -> Closest {
        let inverse = self.rotation.inverse();
        let q0 = inverse * (p0 - self.center);
        let q1 = inverse * (p1 - self.center);
        let h = self.half;
        let d = q1 - q0;
        let outside = |t: f32| {
            let x = q0 + d * t;
            x - x.clamp(-h, h)
        };
        let slope = |t: f32| d.dot(outside(t));

        let t = if slope(0.0) >= 0.0 {
            0.0
        } else if slope(1.0) <= 0.0 {
            1.0
        } else {
            root_between_kinks(q0, d, h, slope)
        };
        let x = q0 + d * t;
        let e = outside(t);
        let local_up = inverse * up;
        let distance = e.length();
        if distance > 1.0e-6 {
            let normal = e / distance;
            let mut surface = Vec3::ZERO;
            let mut faces = 0;
            let mut most = f32::MIN;
            for axis in 0..3 {
                // Less than a thousandth of the gap: rounding, not a second face.
                if e[axis].abs() > 1.0e-3 * distance {
                    faces += 1;
                    let face = Vec3::AXES[axis] * e[axis].signum();
                    if face.dot(local_up) > most {
                        most = face.dot(local_up);
                        surface = face;
                    }
                }
            }
            return Closest {
                distance,
                // On one face only: its exact normal, not one tilted by rounding.
                normal: self.rotation * if faces == 1 { surface } else { normal },
                point: self.center + self.rotation * (x - e),
                on_face: faces == 1,
                surface: self.rotation * surface,
            };
        }

        let mut depth = f32::MAX;
        let mut normal = Vec3::Y;
        for axis in 0..3 {
            for sign in [1.0f32, -1.0] {
                let need = h[axis] - (q0[axis] * sign).min(q1[axis] * sign);
                if need < depth {
                    depth = need;
                    normal = Vec3::AXES[axis] * sign;
                }
            }
        }
        let normal = self.rotation * normal;
        Closest {
            distance: -depth,
            normal,
            point: self.center + self.rotation * x,
            on_face: true,
            surface: normal,
        }
    }

    /// Distance along `dir` at which a ray enters, with the face's normal; a start inside gives
    /// `None`.
    pub fn cast_ray(&self, origin: Vec3, dir: Vec3, max: f32) -> Option<(f32, Vec3)> {
        let inverse = self.rotation.inverse();
        let o = inverse * (origin - self.center);
        let d = inverse * dir;
        let mut enter = f32::MIN;
        let mut leave = f32::MAX;
        let mut normal = Vec3::ZERO;
        for axis in 0..3 {
            // No ray slips between two boxes that stand side by side.
            let aside = d[axis].abs() < 0.5;
            let half = self.half[axis] + if aside { RAY_SLACK } else { 0.0 };
            if d[axis].abs() < 1.0e-9 {
                if o[axis].abs() > half {
                    return None;
                }
                continue;
            }
            let near = (-half * d[axis].signum() - o[axis]) / d[axis];
            let far = (half * d[axis].signum() - o[axis]) / d[axis];
            if near > enter {
                enter = near;
                normal = Vec3::AXES[axis] * -d[axis].signum();
            }
            leave = leave.min(far);
        }
        (enter <= leave && enter >= 0.0 && enter <= max).then(|| (enter, self.rotation * normal))
    }
}

/// The root of the non-decreasing, piecewise linear `slope` between 0 and 1.
fn root_between_kinks(q0: Vec3, d: Vec3, h: Vec3, slope: impl Fn(f32) -> f32) -> f32 {
    let mut low = (0.0, slope(0.0));
    let mut high = (1.0, slope(1.0));
    for axis in 0..3 {
        if d[axis].abs() < 1.0e-12 {
            continue;
        }
        for side in [-h[axis], h[axis]] {
            let t = (side - q0[axis]) / d[axis];
            if t > low.0 && t < high.0 {
                let g = slope(t);
                if g < 0.0 {
                    low = (t, g);
                } else {
                    high = (t, g);
                }
            }
        }
    }
    let rise = high.1 - low.1;
    if rise > 0.0 {
        low.0 + (high.0 - low.0) * (-low.1 / rise)
    } else {
        low.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_sampled_point_is_closer_than_the_closest() {
        let mut seed = 3u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for _ in 0..2000 {
            let mut v = || Vec3::new(next(), next(), next());
            let cuboid = Cuboid {
                center: v(),
                rotation: Quat::from_scaled_axis(v() * 3.0),
                half: v().abs() * 0.5 + 0.05,
            };
            let (p0, p1) = (v() * 2.0, v() * 2.0);
            let found = cuboid.closest_to_segment(p0, p1, Vec3::Y);
            let mut least = f32::MAX;
            for k in 0..=200 {
                let x = cuboid.rotation.inverse() * (p0.lerp(p1, k as f32 / 200.0) - cuboid.center);
                least = least.min((x - x.clamp(-cuboid.half, cuboid.half)).length());
            }
            if found.distance >= 0.0 {
                assert!(found.distance <= least + 1e-5, "{found:?} {least}");
                assert!(found.distance >= least - 0.02, "{found:?} {least}");
            } else {
                assert!(least < 0.02, "{found:?} {least}");
                let depth = -found.distance;
                let moved = cuboid.closest_to_segment(
                    p0 + found.normal * (depth + 0.01),
                    p1 + found.normal * (depth + 0.01),
                    Vec3::Y,
                );
                assert!(
                    moved.distance > 0.0,
                    "pushed out by its depth it is free: {moved:?}"
                );
            }
        }
    }

    #[test]
    fn the_top_face_is_the_surface_of_a_top_edge() {
        let cuboid = Cuboid {
            center: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            half: Vec3::ONE,
        };
        let c =
            cuboid.closest_to_segment(Vec3::new(1.3, 1.4, 0.0), Vec3::new(1.3, 3.0, 0.0), Vec3::Y);
        assert!(
            (c.distance - 0.5).abs() < 1e-6 && !c.on_face && c.surface == Vec3::Y,
            "{c:?}"
        );
    }

    #[test]
    fn a_ray_enters_by_the_near_face() {
        let cuboid = Cuboid {
            center: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            half: Vec3::ONE,
        };
        let hit = cuboid.cast_ray(Vec3::new(0.5, 3.0, 0.0), Vec3::NEG_Y, 10.0);
        assert_eq!(hit, Some((2.0, Vec3::Y)));
        assert_eq!(
            cuboid.cast_ray(Vec3::new(1.5, 3.0, 0.0), Vec3::NEG_Y, 10.0),
            None
        );
    }
}
